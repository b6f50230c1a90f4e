#pragma once
/// The comb of systematic resampling (Kitagawa 1996) in whole numbers: `count` teeth of width 2^32 laid over
/// the cumulative weights. Whole-number sums are exact, so it does not matter where they are cut into blocks.

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pos::filters {

class Comb {
 public:
  /// `total` is the weights' sum, offset in (0, 1) shifts the teeth. count below 2^31.
  Comb(double total, std::size_t count, double offset)
      : per_weight_(static_cast<float>(0x1p32 * static_cast<double>(count) / total)),
        before_first_(0xffffffffU - static_cast<std::uint64_t>(offset * 0x1p32)),
        count_(count) {}

  /// What a parent of this weight adds to the cumulative sum: 2^32 a child. Rounded in float, to 1e-7 of it.
  std::uint64_t share(float weight) const {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(weight * per_weight_));
  }

  /// Children of all parents up to a cumulative sum: the teeth k with (k + offset) 2^32 below it.
  std::size_t children(std::uint64_t cumulative) const {
    return std::min<std::size_t>((cumulative + before_first_) >> 32U, count_);
  }

  std::size_t count() const { return count_; }

 private:
  float per_weight_;
  std::uint64_t before_first_;
  std::size_t count_;
};

}  // namespace pos::filters
