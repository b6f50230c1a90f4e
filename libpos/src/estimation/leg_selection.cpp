#include "pos/estimation/leg_selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::estimation {

ZoneSide sideOf(int mode, Travel travel) {
  using enum ZoneSide;
  static constexpr std::array<std::array<ZoneSide, 2>, 9> kModes{
      {{B, A}, {B, B}, {B, Both}, {Both, A}, {Both, B}, {Both, Both}, {A, A}, {A, B}, {A, Both}}};
  ensure(mode >= 1 && mode <= 9, "a mode of selection that Table 1 does not have");
  return kModes[static_cast<std::size_t>(mode - 1)][travel == Travel::Forward ? 0 : 1];
}

LegWindow::LegWindow(const SelectionConfig& config, double spacing, int mode)
    : mode_(mode),
      near_(config.distance),
      one_sided_(config.distance + config.features * spacing),
      two_sided_(config.distance + 0.5 * config.features * spacing) {}

bool LegWindow::inside(Travel travel, double along, double margin) const {
  const ZoneSide side = sideOf(mode_, travel);
  const double away = side == ZoneSide::A || (side == ZoneSide::Both && along >= 0.0) ? along : -along;
  const double far = side == ZoneSide::Both ? two_sided_ : one_sided_;
  return away >= near_ - margin && away < far + margin;
}

void FaceProgress::start(double station) {
  *this = FaceProgress(face_, zone_lag_);
  const bool at_end_2 = station > 0.5 * face_.length;
  end_ = at_end_2 ? 1 : 2;
  turn(at_end_2 ? Travel::Backward : Travel::Forward, station);
}

void FaceProgress::turn(Travel travel, double station) {
  travel_ = travel;
  reached_ = sign() * station;
}

FaceProgress::Event FaceProgress::step(double station, double speed, double dt) {
  if (std::abs(speed) < face_.standing_speed) {
    standing_ += dt;
  } else {
    standing_ = 0.0;
    const Travel travel = speed > 0.0 ? Travel::Forward : Travel::Backward;
    // During a pass supports stay where the farthest point left them, whichever way it backs.
    if (travel != travel_ && in_pass_) travel_ = travel;
    if (travel != travel_) turn(travel, station);
  }
  const double away = std::abs(station - endStation());
  if (in_pass_) {
    const double pass_sign = end_ == 2 ? 1.0 : -1.0;
    reached_ = std::max(reached_, pass_sign * station);
    if (!standing() || away > face_.arrival_zone) return Event::None;
    in_pass_ = left_ = false;
    ++arrivals_;
    reached_ = sign() * station;
    return Event::Arrived;
  }
  reached_ = std::max(reached_, sign() * station);
  left_ = left_ || away > kLeft;
  const bool back = left_ && standing() && away < face_.arrival_zone;
  if (!back && away < face_.excursion_max) return Event::None;
  in_pass_ = true;
  end_ = end_ == 2 ? 1 : 2;
  turn(end_ == 2 ? Travel::Forward : Travel::Backward, station);
  return back ? Event::Returned : Event::Departed;
}

bool FaceProgress::mayHaveMoved(double station) const {
  const double s = in_pass_ ? (end_ == 2 ? 1.0 : -1.0) : sign();
  return reached_ - s * station > zone_lag_;
}

std::optional<int> SupportLattice::numberAt(double station) const {
  if (!known_) return 0;
  const double steps = (station - shift_) / spacing_;
  const double nearest = std::round(steps);
  if (std::abs(steps - nearest) * spacing_ > gate_) return std::nullopt;
  return static_cast<int>(nearest);
}

void SupportLattice::found(int number, double station) {
  constexpr double kFollow = 0.3;  // share of what one support strays
  const double strays = station - stationOf(number);
  shift_ += (known_ ? kFollow : 1.0) * strays;
  known_ = true;
}

}  // namespace pos::estimation
