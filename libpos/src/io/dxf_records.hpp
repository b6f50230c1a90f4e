#pragma once
/// DXF text as records: an entity's type and the group codes that follow. Internal to io.

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pos/io/dxf.hpp"

namespace pos::io::dxf {

struct Group {
  int code = 0;
  std::string_view value = {};
  int line = 0;  ///< of the code
};

/// Group 0 and everything up to the next group 0.
struct Record {
  std::string_view type = {};
  std::span<const Group> groups = {};  ///< without the group 0
  int line = 0;

  std::string_view text(int code) const;
  bool has(int code) const;
};

struct Groups {
  std::vector<Group> all;
  bool complete = false;
  std::optional<double> stated_unit;  ///< of our own exports, in a comment
};
/// Throws DataError where a group code is no whole number.
Groups groupsOf(std::string_view text, const std::string& file);
std::vector<Record> recordsOf(const std::vector<Group>& groups);

/// Reads numbers of a record and remembers whether one was none.
class Numbers {
 public:
  explicit Numbers(const Record& record) : record_(record) {}
  double operator()(int code, double otherwise);
  /// A coordinate or radius that has to be there.
  double need(int code);
  int whole(int code, int otherwise);
  Eigen::Vector3d point();
  /// Empty when everything read so far was good.
  const std::string& trouble() const { return trouble_; }
  double checked(std::string_view text, int code);

 private:
  const Record& record_;
  std::string trouble_;
};

/// Texts as people read them: %%d and \U+00E4 resolved, no control characters, valid UTF-8.
std::string plainText(std::string_view text);

/// One record (a POLYLINE or INSERT with those that belong to it) read as an entity.
struct Insert {
  DxfEntity symbol;
  Eigen::Vector3d scale{1.0, 1.0, 1.0};
  double rotation = 0.0;  // rad
  int columns = 1;
  int rows = 1;
  double column_step = 0.0;
  double row_step = 0.0;
  bool mirrored = false;  // extrusion points down
};
struct Content {
  std::vector<DxfEntity> entities;
  std::vector<std::pair<std::size_t, Insert>> inserts;  // before which entity it stands
};
struct Block {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  Content content;
};

/// Counts what is left out, by layer, type and reason.
class SkipList {
 public:
  void add(std::string_view layer, std::string_view type, const std::string& reason, int line,
           std::size_t count = 1);
  std::vector<DxfSkipped> list() const;

 private:
  std::map<std::string, DxfSkipped> found_;
};

/// Entities from `records[at]` up to the record of type `end`; `at` is left there.
Content contentOf(const std::vector<Record>& records, std::size_t& at, std::string_view end,
                  SkipList& skipped);

/// The content with its blocks drawn. Throws DataError when they are too many.
std::vector<DxfEntity> expanded(const Content& content, const std::map<std::string, Block>& blocks,
                                SkipList& skipped, const std::string& file);

}  // namespace pos::io::dxf
