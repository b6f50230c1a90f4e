#include "pos/io/dxf.hpp"

#include "dxf_records.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using namespace dxf;

/// Metres per unit of $INSUNITS.
std::optional<double> unitOfCode(std::string_view code) {
  const auto number = text::integer(code);
  if (!number) return std::nullopt;
  switch (*number) {
    case 1:
      return 0.0254;
    case 2:
      return 0.3048;
    case 3:
      return 1609.344;
    case 4:
      return 1e-3;
    case 5:
      return 1e-2;
    case 6:
      return 1.0;
    case 7:
      return 1e3;
    case 10:
      return 0.9144;
    case 14:
      return 0.1;
    default:
      return std::nullopt;
  }
}

/// Header variables stand as group 9 with their values behind.
void readHeader(const Record& section, DxfDrawing& drawing) {
  std::string_view variable;
  for (const Group& group : section.groups) {
    if (group.code == 9) {
      variable = group.value;
    } else if (variable == "$ACADVER" && group.code == 1) {
      drawing.version = plainText(group.value);
    } else if (variable == "$INSUNITS" && group.code == 70) {
      drawing.metres_per_unit = unitOfCode(group.value);
    }
  }
}

std::map<std::string, Block> blocksOf(const std::vector<Record>& records, std::size_t& at,
                                      SkipList& skipped) {
  std::map<std::string, Block> blocks;
  for (; at < records.size() && records[at].type != "ENDSEC"; ++at) {
    if (records[at].type != "BLOCK") continue;
    const Record& head = records[at];
    Block block;
    Numbers number(head);
    block.base = {number(10, 0.0), number(20, 0.0), number(30, 0.0)};
    SkipList inside;
    block.content = contentOf(records, ++at, "ENDBLK", inside);
    for (const DxfSkipped& entry : inside.list()) {
      skipped.add("(block " + plainText(head.text(2)) + ")", entry.type, entry.reason, entry.first_line,
                  entry.count);
    }
    blocks[std::string(head.text(2))] = std::move(block);
    if (at >= records.size() || records[at].type == "ENDSEC") break;
  }
  return blocks;
}

}  // namespace

DxfDrawing parseDxf(std::string_view text, const std::string& file) {
  const Groups groups = groupsOf(text, file);
  const std::vector<Record> records = recordsOf(groups.all);
  DxfDrawing drawing{.file = file, .metres_per_unit = groups.stated_unit, .complete = groups.complete};
  std::map<std::string, Block> blocks;
  Content content;
  SkipList skipped;
  bool any = false;
  for (std::size_t at = 0; at < records.size(); ++at) {
    if (records[at].type != "SECTION") continue;
    const std::string_view name = records[at].text(2);
    any = true;
    if (name == "HEADER") readHeader(records[at], drawing);
    if (name == "BLOCKS") blocks = blocksOf(records, ++at, skipped);
    if (name == "ENTITIES") content = contentOf(records, ++at, "ENDSEC", skipped);
  }
  if (!any) {
    throw DataError(Complaint{.what = "this is no DXF drawing: it has no sections",
                              .place = {.file = file},
                              .expected = "ASCII DXF, R12 or later"});
  }
  drawing.entities = expanded(content, blocks, skipped, file);
  drawing.skipped = skipped.list();
  return drawing;
}

DxfDrawing loadDxf(const std::filesystem::path& file) {
  return parseDxf(fileText(file), file.string());
}

}  // namespace pos::io
