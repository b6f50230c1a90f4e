/// `range_odometry` per odometry increment and per range, beside the same EKF written out with dense dynamic
/// Eigen: full products, P <- (I - K H) P, no gate, no hypotheses. States: the pose (3); with range scale and
/// offset, gyro bias and wheel scale (7); with an offset for each of 16 anchors as well (23).
#include "pos/estimation/range_odometry.hpp"

#include <vector>

#include "support.hpp"

namespace {

using pos::bench::CircleDrive;
using pos::estimation::RangeOdometryConfig;

constexpr int kAnchors = 16;
constexpr int kReadings = 1000;  // per iteration, after a fresh start
constexpr double kInterval = 0.01;
const Eigen::Vector3d kTag(0.3, 0.1, 1.5);

enum class States { Pose = 3, Calibrated = 7, AnchorOffsets = 23 };

pos::Stamp at(int i) {
  return pos::stampFromSeconds(1.7e9) + i * pos::durationFromSeconds(kInterval);
}

pos::Belief<pos::Pose2> prior() {
  return {CircleDrive::pose(0.0), pos::Vector<3>(4e-4, 4e-4, 1e-4).asDiagonal()};
}

RangeOdometryConfig config(States states) {
  RangeOdometryConfig config;
  config.tags = {{.id = 0, .p_body = kTag}};
  if (states != States::Pose) {
    config.range_scale = {1.0, 1e-3, 1e-6};
    config.range_offset = {0.0, 0.02, 1e-4};
    config.gyro_bias = {0.0, 1e-3, 1e-5};
    config.wheel_scale = {1.0, 1e-2, 1e-5};
  }
  if (states == States::AnchorOffsets) config.anchor_offset = {0.0, 0.02, 1e-4};
  return config;
}

/// The drive as odometry tells of it, from one stamp to the next.
std::vector<pos::Measurement> increments() {
  std::vector<pos::Measurement> readings;
  for (int i = 1; i <= kReadings; ++i) {
    pos::OdometryIncrement odometry;
    odometry.increment = inverse(CircleDrive::pose((i - 1) * kInterval)) * CircleDrive::pose(i * kInterval);
    readings.push_back({at(i), "odometry", odometry});
  }
  return readings;
}

/// Ranges heard while standing at the start, so that nothing but ranges is measured.
std::vector<pos::Measurement> ranges() {
  const auto map = pos::bench::ringOfAnchors(kAnchors);
  const pos::Pose2 start = CircleDrive::pose(0.0);
  const Eigen::Vector2d moved = start * Eigen::Vector2d(kTag.head<2>());
  std::vector<pos::Measurement> readings;
  for (int i = 0; i < kReadings; ++i) {
    const pos::map::Anchor& anchor = map->anchors[static_cast<std::size_t>(i % kAnchors)];
    pos::BeaconRange range;
    range.anchor = anchor.id;
    const Eigen::Vector3d tag(moved.x(), moved.y(), kTag.z());
    range.range = (anchor.p_map - tag).norm() + 0.03 * std::sin(1.7 * i);
    readings.push_back({at(i), "uwb", range});
  }
  return readings;
}

void ours(benchmark::State& state, States states, const std::vector<pos::Measurement>& readings,
          const char* counter) {
  pos::estimation::RangeOdometry filter(config(states), pos::bench::ringOfAnchors(kAnchors));
  std::int64_t applied = 0;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    filter.reset(at(0), prior());
    for (const pos::Measurement& reading : readings) {
      applied += filter.ingest(reading).verdict == pos::Verdict::Applied ? 1 : 0;
    }
  }
  per_item.report(state, counter, kReadings);
  state.counters["applied_share"] =
      static_cast<double>(applied) / (kReadings * static_cast<double>(state.iterations()));
  state.counters["hypotheses"] = filter.diagnostics().front().value;
}

/// The filter as a textbook writes it. x = [x y yaw, range scale, range offset, gyro bias, wheel scale,
/// anchor offsets], as many of them as there are states.
class DenseFilter {
 public:
  explicit DenseFilter(States states)
      : n_(static_cast<int>(states)), x_(Eigen::VectorXd::Zero(n_)), P_(Eigen::MatrixXd::Zero(n_, n_)) {
    const pos::Belief<pos::Pose2> pose = prior();
    x_.head<3>() << pose.mean.x, pose.mean.y, pose.mean.yaw;
    P_.topLeftCorner<3, 3>() = pose.covariance;
    if (n_ == 3) return;
    x_[3] = x_[6] = 1.0;
    P_.diagonal().segment<4>(3) << 1e-6, 4e-4, 1e-6, 1e-4;
    P_.diagonal().tail(n_ - 7).setConstant(4e-4);
  }

  void predict(const pos::Pose2& increment, double dt, const pos::estimation::OdometryNoise& noise) {
    const double bias = n_ > 3 ? x_[5] : 0.0;
    const double scale = n_ > 3 ? x_[6] : 1.0;
    const Eigen::Matrix2d R = pos::rotation2(x_[2] - 0.5 * bias * dt);
    const Eigen::Vector2d moved = R * increment.translation();
    const Eigen::Vector2d dmoved_dyaw = scale * Eigen::Vector2d(-moved.y(), moved.x());
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n_, n_);
    F.block<2, 1>(0, 2) = dmoved_dyaw;
    if (n_ > 3) {
      F.block<2, 1>(0, 5) = -0.5 * dt * dmoved_dyaw;
      F(2, 5) = -dt;
      F.block<2, 1>(0, 6) = moved;
    }
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n_, n_);
    Q.topLeftCorner<3, 3>() = odometryCovariance(noise, increment, dt);
    Q.topLeftCorner<2, 2>() = (R * Q.topLeftCorner<2, 2>() * R.transpose()).eval();
    Q.diagonal().tail(n_ - 3).array() += 1e-8 * dt;
    x_.head<2>() += scale * moved;
    x_[2] = pos::wrapAngle(x_[2] + increment.yaw - bias * dt);
    P_ = F * P_ * F.transpose() + Q;
  }

  void correct(double range, const pos::map::Anchor& anchor, double variance) {
    const Eigen::Vector2d lever = pos::rotation2(x_[2]) * kTag.head<2>();
    Eigen::Vector3d between(x_[0] + lever.x(), x_[1] + lever.y(), kTag.z());
    between -= anchor.p_map;
    const double distance = between.norm();
    const double scale = n_ > 3 ? x_[3] : 1.0;
    const Eigen::Vector2d u = between.head<2>() / distance;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, n_);
    H.leftCols<2>() = scale * u.transpose();
    H(0, 2) = scale * u.dot(Eigen::Vector2d(-lever.y(), lever.x()));
    double predicted = scale * distance;
    if (n_ > 3) {
      H(0, 3) = distance;
      H(0, 4) = 1.0;
      predicted += x_[4];
    }
    if (n_ > 7) {
      H(0, 7 + anchor.id) = 1.0;
      predicted += x_[7 + anchor.id];
    }
    const Eigen::MatrixXd S = H * P_ * H.transpose() + Eigen::MatrixXd::Constant(1, 1, variance);
    const Eigen::MatrixXd K = P_ * H.transpose() * S.inverse();
    x_ += K * Eigen::VectorXd::Constant(1, range - predicted);
    x_[2] = pos::wrapAngle(x_[2]);
    P_ = ((Eigen::MatrixXd::Identity(n_, n_) - K * H) * P_).eval();
  }

  const Eigen::VectorXd& state() const { return x_; }

 private:
  int n_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
};

void increment_ours(benchmark::State& state, States states) {
  ours(state, states, increments(), "ns_per_increment");
}

void increment_dense(benchmark::State& state, States states) {
  const std::vector<pos::Measurement> readings = increments();
  const pos::estimation::OdometryNoise noise = config(states).odometry_noise;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    DenseFilter filter(states);
    for (const pos::Measurement& reading : readings) {
      filter.predict(std::get<pos::OdometryIncrement>(reading.reading).increment, kInterval, noise);
    }
    benchmark::DoNotOptimize(filter.state().data());
  }
  per_item.report(state, "ns_per_increment", kReadings);
}

void range_ours(benchmark::State& state, States states) {
  ours(state, states, ranges(), "ns_per_range");
}

void range_dense(benchmark::State& state, States states) {
  const std::vector<pos::Measurement> readings = ranges();
  const auto map = pos::bench::ringOfAnchors(kAnchors);
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    DenseFilter filter(states);
    for (const pos::Measurement& reading : readings) {
      const auto& range = std::get<pos::BeaconRange>(reading.reading);
      filter.correct(range.range, map->anchors[static_cast<std::size_t>(range.anchor)], 0.01);
    }
    benchmark::DoNotOptimize(filter.state().data());
  }
  per_item.report(state, "ns_per_range", kReadings);
}

BENCHMARK_CAPTURE(increment_ours, pose, States::Pose);
BENCHMARK_CAPTURE(increment_dense, pose, States::Pose);
BENCHMARK_CAPTURE(increment_ours, calibrated, States::Calibrated);
BENCHMARK_CAPTURE(increment_dense, calibrated, States::Calibrated);
BENCHMARK_CAPTURE(increment_ours, anchor_offsets, States::AnchorOffsets);
BENCHMARK_CAPTURE(increment_dense, anchor_offsets, States::AnchorOffsets);
BENCHMARK_CAPTURE(range_ours, pose, States::Pose);
BENCHMARK_CAPTURE(range_dense, pose, States::Pose);
BENCHMARK_CAPTURE(range_ours, calibrated, States::Calibrated);
BENCHMARK_CAPTURE(range_dense, calibrated, States::Calibrated);
BENCHMARK_CAPTURE(range_ours, anchor_offsets, States::AnchorOffsets);
BENCHMARK_CAPTURE(range_dense, anchor_offsets, States::AnchorOffsets);

}  // namespace

BENCHMARK_MAIN();
