#include "unit/report/demo_run.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/random.hpp"

namespace pos::report {

namespace {

constexpr int kPoses = 2000;
const Stamp kStart = stampFromSeconds(1.7e9);

/// Round a rectangle with 8 m corners, standing still for 100 s twice.
Pose2 placeAt(double t) {
  const double moving = t - std::clamp(t - 400.0, 0.0, 100.0) - std::clamp(t - 1300.0, 0.0, 100.0);
  const double angle = 2.0 * kPi * moving / 600.0;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double r =
      1.0 / std::pow(std::pow(std::abs(c) / 60.0, 8.0) + std::pow(std::abs(s) / 25.0, 8.0), 0.125);
  return {80.0 + r * c, 40.0 + r * s, 0.0};
}

Truth demoTruth() {
  Truth truth;
  truth.has_z = false;
  for (int i = 0; i < kPoses; ++i) {
    Pose2 pose = placeAt(i);
    const Pose2 next = placeAt(i + 1.0);
    const double yaw_before = truth.poses.empty() ? kPi / 2.0 : truth.poses.back().T_map_body.yaw();
    const bool moves = std::hypot(next.x - pose.x, next.y - pose.y) > 1e-6;
    pose.yaw = moves ? std::atan2(next.y - pose.y, next.x - pose.x) : yaw_before;
    truth.poses.push_back({kStart + durationFromSeconds(i), Pose3::fromPlanar(pose)});
  }
  return truth;
}

struct Behaviour {
  const char* name;
  const char* type;
  double error;    ///< m, real
  double claimed;  ///< m
  double drift;    ///< m/s
  double us;       ///< per measurement
  bool use_ranges;
};

IngestReport rangeReport(const Behaviour& b, int anchor, RandomStream& noise) {
  if (!b.use_ranges) return {.verdict = Verdict::Unsupported, .reason = "no use for ranges"};
  const bool blocked = noise.bernoulli(anchor == 14 ? 0.25 : 0.03);
  const double offset = anchor == 12 ? 0.12 : 0.0;
  const double innovation = noise.normal(offset, 0.1) + (blocked ? noise.uniform(0.5, 3.0) : 0.0);
  const double nis = innovation * innovation / 0.0121;
  return {.verdict = nis > 8.8 ? Verdict::Gated : Verdict::Applied,
          .dof = 1,
          .nis = nis,
          .innovation = innovation,
          .innovation_sigma = 0.11,
          .reason = nis > 8.8 ? "beyond the gate" : ""};
}

/// Errors wander slowly (a first-order Gauss-Markov process of 20 s), as those of a filter do.
eval::EstimatorRecord record(const Behaviour& b, const Truth& truth, std::uint64_t stream) {
  eval::EstimatorRecord r{b.name, b.type, {}, {}, eval::ResidualCollector(800), {}, {}};
  RandomStream noise(7, stream);
  const double keep = std::exp(-1.0 / 20.0);
  Vector<3> e = Vector<3>::Zero();
  for (int i = 3; i < kPoses; ++i) {
    for (int k = 0; k < 3; ++k) e(k) = keep * e(k) + std::sqrt(1.0 - keep * keep) * noise.normal();
    const TruthPose& t = truth.poses[static_cast<std::size_t>(i)];
    const Pose2 pose = t.T_map_body.planar();
    const double lost = b.drift * i;
    const Pose2 wrong{pose.x + b.error * e(0) + lost, pose.y + b.error * e(1) - 0.6 * lost,
                      pose.yaw + 0.02 * e(2)};
    const double sigma = std::hypot(b.claimed, 1.2 * lost);
    const Vector<3> variances(sigma * sigma, sigma * sigma, 4e-4);
    r.estimates.push_back(planarEstimate(t.stamp, wrong, variances.asDiagonal()));
    r.verdicts.add("odometry", std::nullopt, {.verdict = Verdict::Applied});
    for (int anchor = 11; anchor <= 14; ++anchor) {
      const IngestReport report = rangeReport(b, anchor, noise);
      r.verdicts.add("uwb", anchor, report);
      r.residuals.add(anchor, t.stamp, report);
      r.compute.add(durationFromSeconds(1e-6 * b.us * std::exp(0.3 * noise.normal())));
    }
  }
  r.diagnostics = {{"range_offset_m", 0.0312, 0.004}, {"gyro_bias_rad_s", -0.00021, 0.00005}};
  return r;
}

map::TunnelMap demoMap() {
  map::TunnelMap map;
  map.name = "block";
  const std::array<Eigen::Vector3d, 4> places{{{15, 10, 2}, {145, 12, 2}, {144, 69, 2}, {16, 68, 2}}};
  for (int i = 0; i < 4; ++i)
    map.anchors.push_back({11 + i, i == 0 ? "portal" : "", places[static_cast<std::size_t>(i)]});
  map::OccupancyGrid grid;
  grid.resolution = 0.5;
  grid.columns = 340;
  grid.rows = 180;
  grid.x_min = -5.0;
  grid.y_min = -5.0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x = std::abs(grid.x_min + 0.5 * column - 80.0);
      const double y = std::abs(grid.y_min + 0.5 * row - 40.0);
      const double r = std::pow(std::pow(x / 60.0, 8.0) + std::pow(y / 25.0, 8.0), 0.125);
      const bool roadway = r > 0.88 && r < 1.12;
      const bool wall = r > 0.84 && r < 1.17;
      grid.occupancy.push_back(roadway ? 0 : wall ? 100 : map::OccupancyGrid::kUnknown);
    }
  }
  map.grid = std::move(grid);
  return map;
}

}  // namespace

eval::RunSummary demoRun() {
  const Truth truth = demoTruth();
  eval::RunSummary run;
  run.run = "block <A&B> \"demo\"";
  run.log = "block_a.rawlog";
  run.map = "maps/block/map.yaml";
  run.seed = 7;
  run.start = kStart;
  run.end = truth.poses.back().stamp;
  run.log_end = {
      .damaged = true, .objects = 18000, .byte = 1234567, .message = "the last object is cut short"};
  run.has_truth = true;
  run.truth_path = eval::pathOf(truth, run.start);
  run.tunnel_map = std::make_shared<const map::TunnelMap>(demoMap());
  const std::array<Behaviour, 4> behaviours{
      {{"range_odometry", "range_odometry", 0.18, 0.18, 0.0, 3.1, true},
       {"mcl", "mcl", 0.31, 0.14, 0.0, 420.0, true},
       {"mrpt_mcl", "mrpt_mcl", 0.44, 0.60, 0.0, 2300.0, true},
       {"dead_reckoning", "dead_reckoning", 0.1, 0.1, 0.004, 0.4, false}}};
  for (std::size_t i = 0; i < behaviours.size(); ++i) {
    run.estimators.push_back(eval::summarise(record(behaviours[i], truth, i), &truth, run.start));
  }
  return run;
}

}  // namespace pos::report
