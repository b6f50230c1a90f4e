#pragma once
/// Files told by their first bytes. Private to io.

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace pos::io {

/// False, too, for a file that is not there or too short.
inline bool beginsWith(const std::filesystem::path& path, std::string_view magic) {
  std::string head(magic.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(head.data(), static_cast<std::streamsize>(head.size())) && head == magic;
}

}  // namespace pos::io
