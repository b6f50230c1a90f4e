// Scans of the shearer: legs in them, and the gate roads at the ends.
#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/estimation/shearer.hpp"
#include "pos/lidar/leg_association.hpp"
#include "shearer_parts.hpp"

namespace pos::estimation {
namespace {

/// Where along the track legs are looked for: as far as the selection reaches, and one support more.
lidar::AlongFace reachOf(const ShearerConfig& config, const ShearerFilter& filter) {
  const double far = config.selection.distance + (config.selection.features + 1) * config.legs.spacing;
  const double near = std::max(0.0, config.selection.distance - config.legs.spacing);
  switch (sideOf(filter.mode(), filter.progress().travel())) {
    case ZoneSide::A:
      return {near, far};
    case ZoneSide::B:
      return {-far, -near};
    case ZoneSide::Both:
      break;
  }
  return {-far, far};
}

}  // namespace

lidar::LegConfig legFinderOf(const LegsConfig& legs) {
  return {.diameter = legs.diameter,
          .lateral = legs.lateral,
          .lateral_tolerance = legs.lateral_gate,
          .sigma_range = legs.range_sigma,
          .calibration = legs.calibration};
}

IngestReport Shearer::take(const Measurement& measurement, const Scan2D& scan) {
  if (scan.ranges.empty()) return refusal(Verdict::Degenerate, "a scan without beams");
  if (!config_.face.roadway_sensor.empty() && measurement.sensor == config_.face.roadway_sensor)
    return takeRoadway(scan);
  if (measurement.sensor != config_.legs.sensor)
    return refusal(Verdict::Unsupported, "not the scanner that sees the legs (legs.sensor)");
  if (scan.ranges.size() == 1) return takePoint(measurement.stamp, scan);
  return takeSweep(measurement.stamp, scan);
}

/// A leg measured as a point: the beam's mount is turned to look at it.
IngestReport Shearer::takePoint(Stamp stamp, const Scan2D& scan) {
  if (scan.valid.front() == 0) return refusal(Verdict::Degenerate, "the beam did not come back");
  const Eigen::Vector3d direction(std::cos(scan.angle_first), std::sin(scan.angle_first), 0.0);
  const Eigen::Vector3d p_body = scan.T_body_sensor * Eigen::Vector3d(scan.ranges.front() * direction);
  return takeLeg(stamp, p_body - config_.legs.place, config_.legs.sigma.cwiseAbs2().asDiagonal());
}

/// Every leg of a sweep that a filter may use, in the order of the beams. Applied when one of them was.
IngestReport Shearer::takeSweep(Stamp stamp, const Scan2D& scan) {
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  lidar::AlongFace part = reachOf(config_, filters_.front());
  for (const ShearerFilter& filter : filters_) {
    const lidar::AlongFace other = reachOf(config_, filter);
    part = {std::min(part.from, other.from), std::max(part.to, other.to)};
  }
  const lidar::LegSweep sweep = finder_.find(scan, part);
  if (sweep.view == lidar::LegView::NoReturns)
    return refusal(Verdict::Degenerate, "no beam of the sweep came back");
  IngestReport report =
      refusal(Verdict::Unsupported, "no leg of the sweep is one that the mode of selection uses");
  const Eigen::Matrix3d R = scan.T_body_sensor.rotation.toRotationMatrix();
  for (const lidar::LegDetection& leg : sweep.legs) {
    const Eigen::Vector3d p_body = scan.T_body_sensor * Eigen::Vector3d(leg.centre.x(), leg.centre.y(), 0.0);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    covariance.topLeftCorner<2, 2>() = leg.covariance;
    covariance(2, 2) = square(config_.legs.sigma.z());
    const IngestReport one = takeLeg(stamp, p_body - config_.legs.place, R * covariance * R.transpose());
    if (one.verdict == Verdict::Applied) {
      report = {.verdict = Verdict::Applied, .dof = report.dof + one.dof, .nis = report.nis + one.nis};
    } else if (one.verdict == Verdict::Gated && report.verdict == Verdict::Unsupported) {
      report = one;
      report.dof = 0;
      report.nis = 0.0;
    }
  }
  return report;
}

IngestReport Shearer::takeLeg(Stamp stamp, const Eigen::Vector3d& measured,
                              const Eigen::Matrix3d& covariance) {
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  const double age = seconds(stamp - *imu_.stamp());
  LegReport told{.verdict = Verdict::Unsupported};
  for (ShearerFilter& filter : filters_) {
    const LegReport now = filter.see(measured, covariance, age);
    if (&filter == &filters_.front() || told.verdict == Verdict::Unsupported) told = now;
  }
  if (keeping_ && told.verdict != Verdict::Unsupported)
    kept_.emplace_back(KeptLeg{measured, covariance, age});
  return {.verdict = told.verdict,
          .dof = told.taken_up || told.verdict == Verdict::Unsupported ? 0 : 3,
          .nis = told.nis,
          .reason = told.reason};
}

// ---------------------------------------------------------------- creep

IngestReport Shearer::take(const Measurement& measurement, const OdometryIncrement& odometry) {
  return roll(wheels_.take(measurement.stamp, odometry));
}

IngestReport Shearer::take(const Measurement& measurement, const WheelSpeeds& speeds) {
  return roll(wheels_.take(measurement.stamp, speeds));
}

IngestReport Shearer::roll(const WheelIntake::Told& told) {
  if (config_.end_fix.first_cut_along_sigma == 0.0)
    return refusal(Verdict::Unsupported,
                   "an odometer serves a surveyed first cut (end_fix), and there is none");
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  if (told.verdict != Verdict::Applied) return refusal(told.verdict, told.reason);
  for (ShearerFilter& filter : filters_) filter.rolled(told.reading.way.middle());
  return {.verdict = Verdict::Applied};
}

/// The shearer stops at the same place of its conveyor before and after: nothing in a log tells otherwise.
IngestReport Shearer::takeRoadway(const Scan2D& sweep) {
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  const ShearerFilter& filter = best();
  const ins::NavigationState& nav = filter.belief().mean.nav;
  const CreepLook look{.T_map_body = {nav.coordinates - nav.q_n_b * config_.imu_place, nav.q_n_b},
                       .R_face_body = (faceAxes() * nav.q_n_b).toRotationMatrix(),
                       .station = filter.station(),
                       .speed = filter.alongSpeed()};
  IngestReport report{.verdict = Verdict::Applied};
  if (const auto told = creep_.take(sweep, look)) {
    report.event = told->creep.usable ? "creep of the end operation measured"
                                      : "creep not told: the walls do not hold the face's direction";
  }
  return report;
}

/// Map axes to face axes: the shearer's at the start as computed (eq. 9, C_n^m(t0)).
Eigen::Quaterniond Shearer::faceAxes() const {
  const Eigen::Quaterniond q_m_face(Eigen::AngleAxisd(-0.5 * kPi, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond q_n_m =
      best().first().q_n_b * quaternionFromRotationVector(config_.picm.body_mount);
  return (q_n_m * q_m_face).conjugate();
}

// ---------------------------------------------------------------- pictures

LegScene Shearer::legScene(const Scan2D& sweep) const {
  if (!running_) return {};
  LegScene scene = best().expectedLegs();
  scene.radius = 0.5 * config_.legs.diameter;
  scene.gate = config_.legs.association_gate;
  std::vector<lidar::PredictedLeg> predicted;
  for (const LegScene::Expected& leg : scene.expected) predicted.push_back({leg.support, leg.p});
  lidar::LegFinder finder(legFinderOf(config_.legs));
  std::vector<Eigen::Vector2d> points;
  for (const lidar::LegDetection& leg : finder.find(sweep).legs) {
    const Eigen::Vector3d p_body = sweep.T_body_sensor * Eigen::Vector3d(leg.centre.x(), leg.centre.y(), 0.0);
    const Eigen::Matrix3d R = sweep.T_body_sensor.rotation.toRotationMatrix();
    const Eigen::Vector3d seen = corrected(p_body - config_.legs.place, best().belief().mean.sensor).p;
    points.emplace_back(seen.head<2>());
    scene.found.push_back(
        {.p = points.back(),
         .covariance = R.topLeftCorner<2, 2>() * leg.covariance * R.topLeftCorner<2, 2>().transpose()});
  }
  const auto answers = lidar::associated(points, predicted, config_.legs.association_gate);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (answers[i].match != lidar::LegMatch::Matched) continue;
    scene.found[i].support = predicted[static_cast<std::size_t>(answers[i].predicted)].support;
    scene.found[i].used = best().belief().mean.indexOf(*scene.found[i].support).has_value();
  }
  return scene;
}

}  // namespace pos::estimation
