#include "pos/core/error.hpp"
#include "pos/io/log_cache.hpp"
#include "pos/io/log_reader.hpp"
#include "pos/io/mcap_log.hpp"
#include "pos/io/rawlog_reader.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

/// The packed copy beside `log`, where there is one that still belongs to it; else `note` says why not.
std::unique_ptr<LogReader> copyBeside(const std::string& log, std::string& note) {
  const fs::path beside = cacheBeside(log);
  if (!fs::is_regular_file(log) || !fs::is_regular_file(beside)) return nullptr;
  try {
    auto reader = std::make_unique<LogCacheReader>(beside);
    if (reader->belongsTo(log)) {
      note = "read from its packed copy " + beside.string();
      return reader;
    }
    note = "the log has changed since " + beside.string() + " was made of it: the log itself is read";
  } catch (const DataError&) {
    note = beside.string() + " is no packed copy that can be read: the log itself is read";
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<LogReader> openLogItself(const std::string& path) {
  if (isLogCache(path)) return std::make_unique<LogCacheReader>(path);
  if (isMcap(path)) return std::make_unique<McapLogReader>(path);
  return std::make_unique<RawlogReader>(path);
}

OpenedLog openLog(const std::string& path) {
  OpenedLog opened;
  opened.reader = copyBeside(path, opened.note);
  if (opened.reader == nullptr) opened.reader = openLogItself(path);
  return opened;
}

}  // namespace pos::io
