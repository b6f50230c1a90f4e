/// libFuzzer entry: any bytes as a CSV table, an import mapping or a trajectory load or
/// throw pos::Error.

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/import_mapping.hpp"
#include "pos/io/trajectory_io.hpp"

namespace {

template <class Load>
void attempt(Load load) {
  try {
    load();
  } catch (const pos::Error&) {
    // The expected answer to a bad text; anything else escapes and is reported by the fuzzer.
  }
}

void readTable(const std::string& text) {
  pos::io::CsvReader table(text, "table.csv");
  while (table.next()) (void)table.number(0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  attempt([&] { readTable(text); });
  attempt([&] { (void)pos::io::parseImportMapping(text, "mapping.yaml"); });
  static const std::filesystem::path kPath =
      std::filesystem::temp_directory_path() / ("pos_fuzz_" + std::to_string(::getpid()) + ".tum");
  std::ofstream(kPath, std::ios::binary | std::ios::trunc) << text;
  attempt([] { (void)pos::io::readTumTruth(kPath); });
  attempt([] { (void)pos::io::readTum(kPath); });
  attempt([] { (void)pos::io::readEurocTruth(kPath); });
  attempt([] { (void)pos::io::readEstimateCsv(kPath); });
  return 0;
}
