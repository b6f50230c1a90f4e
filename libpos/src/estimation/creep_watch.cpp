#include "pos/estimation/creep_watch.hpp"

#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kNear = 5.0;   // m from an end: a sweep of its gate road
constexpr double kLeft = 10.0;  // m from it: the end operation has begun

}  // namespace

std::optional<DwellCreep> CreepWatch::take(const Scan2D& sweep, const CreepLook& look) {
  const int nearer = look.station > 0.5 * face_.length ? 2 : 1;
  if (nearer != end_) {
    end_ = nearer;
    left_ = false;
    before_.reset();
    after_.reset();
  }
  const double away = std::abs(look.station - endAt(end_));
  if (away < kNear) {
    keepStanding(left_ ? after_ : before_, sweep, look);
    return std::nullopt;
  }
  if (before_ && after_) {
    creeps_.push_back(measured());
    before_.reset();
    after_.reset();
    left_ = false;
    return creeps_.back();
  }
  left_ = left_ || (before_ && away > kLeft);
  return std::nullopt;
}

void CreepWatch::keepStanding(std::optional<Stand>& stand, const Scan2D& sweep, const CreepLook& look) const {
  if (std::abs(look.speed) >= face_.standing_speed) return;
  stand = Stand{lidar::wallPoints(sweep, {.calibration = calibration_}), sweep.T_body_sensor, look};
}

DwellCreep CreepWatch::measured() const {
  const Pose3 T_sensor_body = inverse(before_->T_body_sensor);
  const Pose3 guess =
      T_sensor_body * inverse(before_->look.T_map_body) * after_->look.T_map_body * inverse(T_sensor_body);
  const lidar::IcpResult walls = lidar::registered(before_->walls, after_->walls, guess.planar());
  const lidar::DwellStand stand{.T_body_sensor = before_->T_body_sensor,
                                .R_face_body = before_->look.R_face_body,
                                .stop_difference = after_->look.rack - before_->look.rack};
  return {.operation = static_cast<int>(creeps_.size()) + 1,
          .creep = lidar::creepOf(walls, stand),
          .weak_share = walls.shares[0]};
}

}  // namespace pos::estimation
