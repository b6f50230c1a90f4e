// SHA-256 as in FIPS 180-4; the letters a..h, W, K, H, sigma are those of the standard.
#include "pos/io/sha256.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

using Word = std::uint32_t;
using State = std::array<Word, 8>;
constexpr std::size_t kBlock = 64;

constexpr std::array<Word, 64> kK{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

Word smallSigma0(Word x) {
  return std::rotr(x, 7) ^ std::rotr(x, 18) ^ (x >> 3U);
}
Word smallSigma1(Word x) {
  return std::rotr(x, 17) ^ std::rotr(x, 19) ^ (x >> 10U);
}
Word bigSigma0(Word x) {
  return std::rotr(x, 2) ^ std::rotr(x, 13) ^ std::rotr(x, 22);
}
Word bigSigma1(Word x) {
  return std::rotr(x, 6) ^ std::rotr(x, 11) ^ std::rotr(x, 25);
}

std::array<Word, 64> schedule(const char* block) {
  std::array<Word, 64> W{};
  for (std::size_t t = 0; t < 64; ++t) {
    if (t < 16) {
      for (std::size_t i = 0; i < 4; ++i) W[t] = (W[t] << 8U) | static_cast<unsigned char>(block[4 * t + i]);
    } else {
      W[t] = smallSigma1(W[t - 2]) + W[t - 7] + smallSigma0(W[t - 15]) + W[t - 16];
    }
  }
  return W;
}

State compressed(const State& H, const char* block) {
  const std::array<Word, 64> W = schedule(block);
  auto [a, b, c, d, e, f, g, h] = H;
  for (std::size_t t = 0; t < 64; ++t) {
    const Word T1 = h + bigSigma1(e) + ((e & f) ^ (~e & g)) + kK[t] + W[t];
    const Word T2 = bigSigma0(a) + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + T1;
    d = c;
    c = b;
    b = a;
    a = T1 + T2;
  }
  return {H[0] + a, H[1] + b, H[2] + c, H[3] + d, H[4] + e, H[5] + f, H[6] + g, H[7] + h};
}

class Sha256 {
 public:
  void add(std::string_view bytes) {
    length_ += bytes.size();
    while (!bytes.empty()) {
      const std::size_t taken = std::min(kBlock - used_, bytes.size());
      std::memcpy(block_.data() + used_, bytes.data(), taken);
      bytes.remove_prefix(taken);
      used_ += taken;
      if (used_ < kBlock) continue;
      H_ = compressed(H_, block_.data());
      used_ = 0;
    }
  }

  /// One bit, zeros up to the last 8 bytes of a block, then the length in bits.
  std::string finish() {
    const std::uint64_t bits = 8 * length_;
    add(std::string_view("\x80", 1));
    while (used_ != kBlock - 8) add(std::string_view("\0", 1));
    std::array<char, 8> length{};
    for (std::size_t i = 0; i < 8; ++i) length[i] = static_cast<char>((bits >> (56U - 8U * i)) & 0xffU);
    add({length.data(), length.size()});
    std::string hex;
    for (const Word word : H_) {
      for (unsigned shift = 32; shift > 0; shift -= 4)
        hex += "0123456789abcdef"[(word >> (shift - 4)) & 0xfU];
    }
    return hex;
  }

 private:
  State H_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<char, kBlock> block_{};
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.finish();
}

std::string sha256OfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto fail = [&path] {
    throw DataError(Complaint{.what = "cannot read the file", .place = {.file = path.string()}});
  };
  if (!file || std::filesystem::is_directory(path)) fail();
  Sha256 hash;
  std::vector<char> buffer(1U << 16U);
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.add({buffer.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (file.bad()) fail();
  return hash.finish();
}

}  // namespace pos::io
