/// libFuzzer entry point: any bytes end as a DataError, a damaged log or a clean one. Objects of other
/// classes than those that the reader checks beforehand are MRPT's to read, counts and all
/// (docs/formats/rawlog.md): inputs that reach one are left out. Build with clang: -fsanitize=fuzzer,address,
/// linked with pos_io.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "../../libpos/src/io/byte_source.hpp"
#include "../../libpos/src/io/object_guard.hpp"
#include "pos/core/error.hpp"
#include "pos/io/rawlog_reader.hpp"

namespace {

/// Every object up to the first damage is one that the reader checks.
bool checkedThroughout(const std::string& path) {
  pos::io::ByteSource source(path);
  std::string skipped;
  while (!source.atEnd()) {
    const pos::io::ObjectOutline outline = outlineNext(source);
    if (outline.damage) return true;
    if (!outline.length) return false;
    skipped.resize(*outline.length);
    source.read(skipped.data(), skipped.size());
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kPath =
      (std::filesystem::temp_directory_path() / ("pos_fuzz_" + std::to_string(::getpid()) + ".rawlog"))
          .string();
  std::ofstream(kPath, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    if (!checkedThroughout(kPath)) return 0;
    pos::io::RawlogReader reader(kPath);
    while (const auto measurement = reader.next()) {
      if (pos::defect(*measurement)) std::abort();
    }
  } catch (const pos::DataError&) {
    return 0;
  }
  return 0;
}
