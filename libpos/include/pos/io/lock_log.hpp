#pragma once
/// What a lock engine was told and what it decided, as files: enough for somebody else to judge it again.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/interval/lock_events.hpp"
#include "pos/interval/lock_rules.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {

/// What does not change while it runs.
struct LockScene {
  interval::LockSite site = {};
  interval::LockRules rules = {};
  std::vector<interval::Way> ways = {};
};

std::string lockSceneJson(const LockScene& scene);
/// Throws DataError for text that is none or does not fit together.
LockScene lockSceneFrom(const std::string& text, const std::string& file);

/// Columns stamp_s,row,kind,vehicle,detail (docs/formats/locks.md).
class LockLogWriter {
 public:
  LockLogWriter(const std::filesystem::path& path, std::vector<interval::Way> ways);
  /// Throws DataError for a way that is none of those given.
  void write(const interval::LockEvent& event, const std::vector<interval::LockRecord>& records);
  void close() { lines_.close(); }

 private:
  std::string wayNumber(const interval::Way& way) const;
  std::string detail(const interval::LockEvent& event) const;
  LineWriter lines_;
  std::vector<interval::Way> ways_;
};

/// One event and what came of it.
struct LockStep {
  interval::LockEvent event = {};
  std::vector<interval::LockRecord> records = {};
};

class LockLogReader {
 public:
  LockLogReader(const std::filesystem::path& path, std::vector<interval::Way> ways);
  /// Nothing at the end. Throws DataError with file and line for a row that makes no sense.
  std::optional<LockStep> next();

 private:
  CsvReader table_;
  std::vector<interval::Way> ways_;
  bool pending_ = false;  ///< the table stands on the next event
};

}  // namespace pos::io
