#include "pos/filters/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace pos::filters {

void forBlocksOf(std::size_t particles, Cost cost, const std::function<void(const Block&)>& work) {
  const std::size_t blocks = blockCount(particles);
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      work({.index = b, .first = b * kBlock, .count = std::min(kBlock, particles - b * kBlock)});
    }
  };
  const std::size_t grain = cost == Cost::Low ? 32 : 4;  // blocks for a few tens of microseconds
  if (blocks <= grain) return run(0, blocks);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, grain),
                    [&](const tbb::blocked_range<std::size_t>& part) { run(part.begin(), part.end()); });
}

}  // namespace pos::filters
