#pragma once
/// Arrays that begin on a cache line: a vector of sixteen floats then never lies across two (bench/mcl.cpp: a
/// twentieth of the time of a range's loop).

#include <cstddef>
#include <new>
#include <vector>

namespace pos {

template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }

  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

using FloatArray = std::vector<float, LineAllocator<float>>;

}  // namespace pos
