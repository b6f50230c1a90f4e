/// libFuzzer entry point: any bytes end as a DataError, a damaged log or a clean one.
/// Build with clang: -fsanitize=fuzzer,address, linked with pos_io.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pos/core/error.hpp"
#include "pos/io/rawlog_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kPath =
      (std::filesystem::temp_directory_path() / ("pos_fuzz_" + std::to_string(::getpid()) + ".rawlog"))
          .string();
  std::ofstream(kPath, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    pos::io::RawlogReader reader(kPath);
    while (const auto measurement = reader.next()) {
      if (pos::defect(*measurement)) std::abort();
    }
  } catch (const pos::DataError&) {
    return 0;
  }
  return 0;
}
