#pragma once
/// Checksums of input files.

#include <filesystem>
#include <string>
#include <string_view>

namespace pos::io {

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits, the same as the command `sha256sum` prints.
std::string sha256(std::string_view bytes);
/// Of a file's content. Throws DataError when it cannot be read.
std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace pos::io
