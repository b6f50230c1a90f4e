#pragma once
/// Small tables and their mappings, imported.

#include <gtest/gtest.h>

#include <string>

#include "pos/io/csv_import.hpp"
#include "scratch_folder.hpp"

namespace pos::io {

/// One stream of `kind` in a.csv with these columns.
inline std::string mappingOf(const std::string& kind, const std::string& columns,
                             const std::string& more = {}) {
  return "name: test\norigin_s: 0\nstreams:\n  - kind: " + kind + "\n    file: a.csv\n    columns: {" +
         columns + "}\n" + more;
}

inline ImportResult imported(const std::string& mapping, const std::string& table) {
  const ScratchFolder folder;
  folder.write("a.csv", table);
  return importCsv(parseImportMapping(mapping, "m.yaml"), folder.path());
}

template <class R>
R only(const ImportResult& result) {
  EXPECT_EQ(result.measurements.size(), 1U);
  return std::get<R>(result.measurements.at(0).reading);
}

/// A function: texts at the top of a file are put together before it, in the order that the linker likes.
inline std::string stampColumn() {
  return "stamp: {column: t, unit: s}, ";
}

}  // namespace pos::io
