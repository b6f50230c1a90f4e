#include "pos/estimation/wheel_slide.hpp"

#include <algorithm>

#include "pos/core/chi_square.hpp"
#include "pos/core/square.hpp"

namespace pos::estimation {
namespace {

constexpr double kWindow = 1.0;              // s
constexpr double kTolerance = 0.05;          // s, on the window's ends
constexpr double kSteadyConfidence = 0.999;  // of honest scatter

Eigen::Vector3d differenceOf(const WheelSlideSample& sample) {
  return sample.wheels - sample.inertial;
}

template <class Iterator>
SlideMean meanOf(Iterator first, int count) {
  SlideMean m;
  for (int i = 0; i < count; ++i, ++first) {
    m.difference += differenceOf(*first);
    m.wheels += first->wheels;
    m.variance += square(first->sigma);
  }
  m.difference /= count;
  m.wheels /= count;
  m.variance /= square(count);
  return m;
}

}  // namespace

void WheelSlide::add(const WheelSlideSample& sample) {
  samples_.push_back(sample);
  while (seconds(sample.stamp - samples_.front().stamp) > kWindow + kTolerance) samples_.pop_front();
}

bool WheelSlide::full() const {
  return samples_.size() >= 3 &&
         seconds(samples_.back().stamp - samples_.front().stamp) > kWindow - 2.0 * kTolerance;
}

bool WheelSlide::steady() const {
  return full() && steady(static_cast<int>(samples_.size()));
}

bool WheelSlide::steady(int count) const {
  if (count > static_cast<int>(samples_.size())) return false;
  const Eigen::Vector3d mean = newest(count).difference;
  double scatter = 0.0;
  for (auto s = samples_.rbegin(); s != samples_.rbegin() + count; ++s)
    scatter += (differenceOf(*s) - mean).head<2>().squaredNorm() / square(s->sigma);
  return scatter < chiSquareQuantile(kSteadyConfidence, 2.0 * (count - 1));
}

std::optional<SlideMean> WheelSlide::jump() const {
  if (!full()) return std::nullopt;
  const int third = static_cast<int>(samples_.size()) / 3;
  const SlideMean before = meanOf(samples_.begin(), third);
  const SlideMean after = meanOf(samples_.rbegin(), third);
  return SlideMean{after.difference - before.difference, after.wheels - before.wheels,
                   after.variance + before.variance};
}

void WheelSlide::mark() {
  const int third = std::max(1, static_cast<int>(samples_.size()) / 3);
  if (!samples_.empty()) marked_ = meanOf(samples_.begin(), third).difference;
}

Eigen::Vector3d WheelSlide::fedBack() const {
  if (samples_.empty()) return Eigen::Vector3d::Zero();
  return samples_.back().fed_back - samples_.front().fed_back;
}

SlideMean WheelSlide::newest(int count) const {
  const int there = std::min(count, static_cast<int>(samples_.size()));
  return there > 0 ? meanOf(samples_.rbegin(), there) : SlideMean{};
}

}  // namespace pos::estimation
