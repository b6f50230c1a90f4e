#pragma once
/// Loops over particles cut into blocks that threads may share. The blocks do not depend on the threads, and
/// whoever adds up over blocks does it in their order, so that one thread and several give the same bits.

#include <cstddef>
#include <functional>

namespace pos::filters {

/// Particles of one block; a multiple of 64. Float sums within a block stay good to 1e-5 of their size.
inline constexpr std::size_t kBlock = 2048;

struct Block {
  std::size_t index;
  std::size_t first;
  std::size_t count;
};

inline std::size_t blockCount(std::size_t particles) {
  return (particles + kBlock - 1) / kBlock;
}

/// What one particle costs in a loop, which decides how many particles make a thread worth waking.
enum class Cost { Low, High };

void forBlocksOf(std::size_t particles, Cost cost, const std::function<void(const Block&)>& work);

/// work(block) for every block, by as many threads as oneTBB's arena of the caller allows.
template <class Work>
void forBlocks(std::size_t particles, Cost cost, const Work& work) {
  forBlocksOf(particles, cost, std::cref(work));  // a reference needs no memory of its own
}

}  // namespace pos::filters
