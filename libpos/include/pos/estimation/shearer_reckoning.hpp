#pragma once
/// The shearer's dead reckoning, the paper's baselines: the inertial unit's attitude and the odometer's way
/// (`dr`), and the same with what returning to an end says of the direction's errors (`dr_closed_path`; our
/// stand-in for Wang et al. 2019, of whom the paper prints no formulas). docs/math/shearer.md.

#include <array>
#include <memory>
#include <optional>

#include "pos/estimation/shearer.hpp"

namespace pos::estimation {

class ShearerReckoning final : public Estimator {
 public:
  /// Throws ConfigError for a map without an origin where the Earth turns.
  ShearerReckoning(const ShearerConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  /// xi = [yaw, pitch, their rates, scale]: the true way is (1 - scale) of the odometer's, turned by these.
  static constexpr int kXi = 5;
  using XiRows = Eigen::Matrix<double, 3, kXi>;
  /// The path as summed up, and how it depends on xi.
  struct Path {
    Eigen::Vector3d p_n = Eigen::Vector3d::Zero();
    XiRows by_xi = XiRows::Zero();
  };
  struct Visit {
    Path path;
    int line = 0;
  };

  IngestReport take(Stamp stamp, const ImuSample& sample);
  IngestReport take(Stamp stamp, const OdometryIncrement& odometry);
  IngestReport take(Stamp stamp, const WheelSpeeds& speeds);
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "dead reckoning has no use for this kind of reading"};
  }
  IngestReport roll(Stamp stamp, const WheelIntake::Told& told);
  void start();
  void visit(int end, int line);
  void close(const Visit& before, const Visit& now);

  ShearerConfig config_;
  ins::Earth earth_;
  Eigen::Vector3d along_;
  Eigen::Vector3d right_;
  std::optional<Belief<Pose2>> given_;
  std::optional<Stamp> last_stamp_;
  std::optional<Stamp> started_;
  ImuIntake imu_;
  WheelIntake wheels_;
  FaceProgress progress_;
  ins::NavigationState nav_;
  ins::ImuIncrement last_;
  Path path_;
  Matrix<3, 3> start_covariance_ = Matrix<3, 3>::Zero();
  Vector<kXi> xi_ = Vector<kXi>::Zero();
  Matrix<kXi, kXi> xi_covariance_ = Matrix<kXi, kXi>::Zero();
  double station_ = 0.0;
  std::array<std::optional<Visit>, 2> visits_;  // of end 1, end 2
  int closures_ = 0;
  bool running_ = false;
};

}  // namespace pos::estimation
