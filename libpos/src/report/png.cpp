#include "pos/report/png.hpp"

#include <algorithm>
#include <array>

namespace pos::report {

namespace {

constexpr int kFree = 0;
constexpr int kUncertain = 1;
constexpr int kRock = 2;
constexpr int kNeverSeen = 3;

std::uint8_t kindOf(std::uint8_t occupancy) {
  if (occupancy == map::OccupancyGrid::kUnknown) return kNeverSeen;
  if (occupancy <= 35) return kFree;
  return occupancy < 65 ? kUncertain : kRock;
}

/// What a reader must see first wins: rock, then free, then uncertain, then never seen.
std::uint8_t stronger(std::uint8_t a, std::uint8_t b) {
  constexpr std::array<int, 4> kRank{2, 1, 3, 0};
  return kRank[a] >= kRank[b] ? a : b;
}

std::string bigEndian(std::uint32_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>((value >> shift) & 0xffU);
  return bytes;
}

std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0U ? 0xedb88320U : 0U);
  }
  return ~crc;
}

std::uint32_t adler32(const std::string& bytes) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521U;
    b = (b + a) % 65521U;
  }
  return (b << 16U) | a;
}

std::string chunk(const std::string& type, const std::string& data) {
  return bigEndian(static_cast<std::uint32_t>(data.size())) + type + data + bigEndian(crc32(type + data));
}

/// A zlib stream (RFC 1950) of stored blocks (RFC 1951, section 3.2.4).
std::string stored(const std::string& bytes) {
  constexpr std::size_t kMost = 65535;
  std::string stream = "\x78\x01";
  for (std::size_t at = 0; at < bytes.size() || at == 0; at += kMost) {
    const std::size_t length = std::min(kMost, bytes.size() - at);
    const bool last = at + length >= bytes.size();
    stream += static_cast<char>(last ? 1 : 0);
    for (const std::size_t word : {length, length ^ 0xffffU}) {
      stream += static_cast<char>(word & 0xffU);
      stream += static_cast<char>((word >> 8U) & 0xffU);
    }
    stream += bytes.substr(at, length);
  }
  return stream + bigEndian(adler32(bytes));
}

/// Rows of 2-bit pixels, each behind its filter byte (0 = none).
std::string packedRows(const Picture& picture) {
  std::string rows;
  for (int row = 0; row < picture.rows; ++row) {
    rows += '\0';
    for (int column = 0; column < picture.columns; column += 4) {
      unsigned byte = 0;
      for (int k = 0; k < 4; ++k) {
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.columns) +
                        static_cast<std::size_t>(column + k);
        const unsigned pixel = column + k < picture.columns ? picture.pixels[at] & 3U : 0U;
        byte |= pixel << static_cast<unsigned>(6 - 2 * k);
      }
      rows += static_cast<char>(byte);
    }
  }
  return rows;
}

}  // namespace

GridPicture gridPicture(const map::OccupancyGrid& grid, int most_pixels) {
  GridPicture result;
  result.step = std::max(1, (std::max(grid.columns, grid.rows) + most_pixels - 1) / most_pixels);
  Picture& picture = result.picture;
  picture.columns = (grid.columns + result.step - 1) / result.step;
  picture.rows = (grid.rows + result.step - 1) / result.step;
  picture.pixels.assign(static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows),
                        kNeverSeen);
  for (int row = 0; row < grid.rows; ++row) {
    const int picture_row = (grid.rows - 1 - row) / result.step;
    for (int column = 0; column < grid.columns; ++column) {
      const auto at = static_cast<std::size_t>(picture_row) * static_cast<std::size_t>(picture.columns) +
                      static_cast<std::size_t>(column / result.step);
      picture.pixels[at] = stronger(picture.pixels[at], kindOf(grid.at(column, row)));
    }
  }
  return result;
}

std::string pngBytes(const Picture& picture) {
  std::string header = bigEndian(static_cast<std::uint32_t>(picture.columns)) +
                       bigEndian(static_cast<std::uint32_t>(picture.rows));
  header += std::string("\x02\x03\x00\x00\x00", 5);  // 2 bits, palette, no interlace
  const std::string palette("\x80\x80\x80\x80\x88\x90\x6b\x78\x86\x80\x88\x90", 12);
  const std::string opacity("\x00\x50\xff\x28", 4);
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) + chunk("PLTE", palette) +
         chunk("tRNS", opacity) + chunk("IDAT", stored(packedRows(picture))) + chunk("IEND", "");
}

std::string base64(const std::string& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - at);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = (word << 8U) | (k < have ? static_cast<unsigned char>(bytes[at + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= have ? kDigits[(word >> (18U - 6U * static_cast<unsigned>(k))) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace pos::report
