#include <array>
#include <cstdio>

#include "pos/io/option_core.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

const Alternative* heldAlternative(const TableCore& table, const void* object) {
  for (const Alternative& alternative : table.alternatives) {
    if (alternative.held(object) != nullptr) return &alternative;
  }
  return nullptr;
}

std::string explanation(const Option& option) {
  const bool leaf = option.kind != Option::Kind::Table && option.kind != Option::Kind::List;
  return leaf ? option.text + " (" + expectedText(option) + ")" : option.text;
}

/// A table while it is written: what it holds, and the keys that have no value.
struct Written {
  YamlNode node = tableNode();
  std::string absent = {};
};

std::optional<YamlNode> rowValue(const OptionRow& row, const TableCore& table, const void* object,
                                 Comments comments) {
  if (row.option.key != table.selector) return row.write(object, comments);
  const Alternative* held = heldAlternative(table, object);
  return held ? std::optional(textNode(held->name)) : std::nullopt;
}

/// `so_far` and the rows of the table.
Written withRows(Written so_far, const TableCore& table, const void* object, Comments comments) {
  for (const OptionRow& row : table.rows) {
    std::optional<YamlNode> value = rowValue(row, table, object, comments);
    if (!value) {
      so_far.absent += (so_far.absent.empty() ? "" : ", ") + row.option.key;
      continue;
    }
    if (comments == Comments::Explained) {
      value->comment = explanation(row.option) + (value->comment.empty() ? "" : "\n" + value->comment);
    }
    so_far.node.add(row.option.key, std::move(*value));
  }
  return so_far;
}

// ---- reference -------------------------------------------------------------------------------------------

std::string kindName(const Option& option) {
  switch (option.kind) {
    case Option::Kind::Number:
      return "number";
    case Option::Kind::Numbers:
      return option.count > 0 ? std::to_string(option.count) + " numbers" : "numbers";
    case Option::Kind::Integer:
      return "whole number";
    case Option::Kind::Text:
      return "text";
    case Option::Kind::Choice:
      return "choice";
    case Option::Kind::Flag:
      return "true/false";
    case Option::Kind::Path:
      return "path";
    case Option::Kind::Table:
      return "table";
    case Option::Kind::List:
      return "list";
  }
  return "";
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

std::string allowed(const Option& option) {
  std::string text;
  for (const std::string& choice : option.choices) text += (text.empty() ? "" : ", ") + code(choice);
  return text.empty() ? rangeText(option.range) : text;
}

/// Four digits are enough to read; files get them all.
std::string roundedText(const std::string& number) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", siValue(number, ""));
  return buffer.data();
}

std::string defaultText(const OptionRow& row, const void* defaults) {
  if (row.option.required) return "required";
  if (row.option.kind == Option::Kind::Table) return row.option.optional ? "absent" : "";
  const auto value = row.write(defaults, Comments::None);
  if (!value) return "absent";
  return code(row.option.kind == Option::Kind::Number ? roundedText(value->text) : inlineText(*value));
}

std::string referenceRows(const TableCore& table, const void* defaults, const std::string& prefix) {
  std::string text;
  for (const OptionRow& row : table.rows) {
    const Option& option = row.option;
    const std::string key = prefix + option.key;
    text += "| " + code(key) + " | " + kindName(option) + " | " + std::string(unitOf(option.key).symbol) +
            " | " + allowed(option) + " | " + defaultText(row, defaults) + " | " + option.text + " |\n";
    if (row.table) {
      const auto sample = row.sample(defaults);
      text +=
          referenceRows(*row.table, sample.get(), key + (option.kind == Option::Kind::List ? "[]." : "."));
    }
  }
  return text;
}

constexpr const char* kHead =
    "| key | type | unit | allowed | default | meaning |\n| --- | --- | --- | --- | --- | --- |\n";

/// A section for each alternative found in the table or below it.
std::string alternativeSections(const TableCore& table) {
  std::string text;
  for (const Alternative& alternative : table.alternatives) {
    const auto sample = alternative.sample();
    text += "\n## " + code(table.selector + ": " + alternative.name) + "\n\n" + alternative.text + "\n\n" +
            kHead + referenceRows(*alternative.table, sample.get(), "");
  }
  for (const OptionRow& row : table.rows) {
    if (row.table) text += alternativeSections(*row.table);
  }
  return text;
}

}  // namespace

YamlNode writeTable(const TableCore& table, const void* object, Comments comments) {
  Written written = withRows({}, table, object, comments);
  if (const Alternative* held = heldAlternative(table, object)) {
    written = withRows(std::move(written), *held->table, held->held(object), comments);
  }
  if (comments == Comments::Explained && !written.absent.empty()) {
    written.node.comment = "Further keys, not set here: " + written.absent;
  }
  return std::move(written.node);
}

std::string markdownReference(const TableCore& table, const void* defaults) {
  return "# " + table.title + "\n\n" + table.text + "\n\n" + kHead + referenceRows(table, defaults, "") +
         alternativeSections(table);
}

}  // namespace pos::io
