#include "pos/estimation/lost_detector.hpp"

#include <algorithm>
#include <cstddef>

namespace pos::estimation {
namespace {

constexpr double kLost = 0.5;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void LostDetector::noteRange(Stamp stamp, double evidence) {
  if (stamp != stamp_) settle();
  stamp_ = stamp;
  evidence_.push_back(evidence);
}

void LostDetector::settle() {
  if (evidence_.empty()) return;
  ranges_.add(median(evidence_));
  evidence_.clear();
}

double LostDetector::share() const {
  double share = ranges_.started() || scans_.started() ? 1.0 : 0.0;
  if (ranges_.started()) share = std::min(share, ranges_.injectionShare());
  if (scans_.started()) share = std::min(share, scans_.injectionShare());
  return share < kLost ? 0.0 : share;
}

}  // namespace pos::estimation
