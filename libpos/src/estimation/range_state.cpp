#include "pos/estimation/range_state.hpp"

#include <algorithm>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {
constexpr std::size_t at(StateTerm term) {
  return static_cast<std::size_t>(term);
}
}  // namespace

RangeLayout::RangeLayout(const RangeOdometryConfig& config, const std::vector<AnchorId>& anchors) {
  rows_.fill(-1);
  const auto place = [this](StateTerm term, bool freed, double value) {
    held_[at(term)] = value;
    if (freed) rows_[at(term)] = size_++;
  };
  const bool moving = config.motion == RangeOdometryConfig::Motion::ConstantVelocity;
  place(StateTerm::VelocityX, moving, 0.0);
  place(StateTerm::VelocityY, moving, 0.0);
  place(StateTerm::YawRate, moving, 0.0);
  const auto placeCalibration = [&place](StateTerm term, const CalibrationState& c) {
    place(term, c.sigma > 0.0, c.value);
  };
  placeCalibration(StateTerm::GyroBias, config.gyro_bias);
  placeCalibration(StateTerm::WheelScale, config.wheel_scale);
  placeCalibration(StateTerm::RangeScale, config.range_scale);
  placeCalibration(StateTerm::RangeOffset, config.range_offset);
  placeCalibration(StateTerm::Latency, config.latency);
  if (config.anchor_offset.sigma <= 0.0) return;
  first_anchor_row_ = size_;
  anchors_ = anchors;
  std::sort(anchors_.begin(), anchors_.end());
  size_ += static_cast<int>(anchors_.size());
  if (size_ > RangeState::kMaxDof) {
    throw ConfigError(
        Complaint{.what = "too many anchors for one offset state each",
                  .key = "anchor_offset.sigma_m",
                  .got = std::to_string(anchors_.size()) + " anchors",
                  .expected = "at most " + std::to_string(RangeState::kMaxDof - first_anchor_row_),
                  .suggestion = "set anchor_offset.sigma_m to 0 and give each anchor its range_bias_m"});
  }
}

std::optional<int> RangeLayout::anchorRow(AnchorId anchor) const {
  const auto found = std::lower_bound(anchors_.begin(), anchors_.end(), anchor);
  if (found == anchors_.end() || *found != anchor) return std::nullopt;
  return first_anchor_row_ + static_cast<int>(found - anchors_.begin());
}

double RangeState::value(const RangeLayout& layout, StateTerm term) const {
  const auto row = layout.row(term);
  return row ? values[*row] : layout.held(term);
}

Eigen::Vector2d RangeState::velocity(const RangeLayout& layout) const {
  return {value(layout, StateTerm::VelocityX), value(layout, StateTerm::VelocityY)};
}

RangeState plus(const RangeState& x, const Tangent<RangeState>& d) {
  RangeState result{x.values + d};
  result.values[2] = wrapAngle(result.values[2]);
  return result;
}

Tangent<RangeState> minus(const RangeState& to, const RangeState& from) {
  Tangent<RangeState> d = to.values - from.values;
  d[2] = wrapAngle(d[2]);
  return d;
}

}  // namespace pos::estimation
