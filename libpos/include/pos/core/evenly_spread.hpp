#pragma once
/// Bounded memory for series whose length nobody knows beforehand.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace pos {

/// Keeps elements at even distances, at most `most` of them, the first always: whenever it is full, every
/// second goes and from then on only half as many come in.
template <class Element>
class EvenlySpread {
 public:
  explicit EvenlySpread(std::size_t most) : most_(std::max<std::size_t>(2, most)) {}

  void add(const Element& element) {
    if (seen_++ % stride_ != 0) return;
    if (kept_.size() == most_) {
      halve();
      if ((seen_ - 1) % stride_ != 0) return;
    }
    kept_.push_back(element);
  }

  std::size_t seen() const { return seen_; }
  const std::vector<Element>& kept() const { return kept_; }
  std::vector<Element> take() { return std::move(kept_); }

 private:
  void halve() {
    for (std::size_t i = 1; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
    kept_.resize((kept_.size() + 1) / 2);
    stride_ *= 2;
  }

  std::size_t most_;
  std::size_t seen_ = 0;
  std::size_t stride_ = 1;
  std::vector<Element> kept_;
};

}  // namespace pos
