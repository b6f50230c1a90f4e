#pragma once
/// `dead_reckoning`, variant `odometry`: increments as they come. The yardstick every other estimator must
/// beat. The variants with wheels are in wheel_reckoning.hpp.

#include <optional>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"

namespace pos::estimation {

class DeadReckoning final : public Estimator {
 public:
  explicit DeadReckoning(const DeadReckoningConfig& config) : config_(config) {}

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  DeadReckoningConfig config_;
  Belief<Pose2> belief_;
  std::optional<Stamp> stamp_;
  double distance_ = 0.0;  ///< m travelled
};

/// T_map_now from T_map_previous and the increment, with first-order covariance (tangent [x y yaw], map
/// axes).
Belief<Pose2> compounded(const Belief<Pose2>& previous, const Pose2& increment, const Matrix<3, 3>& Q_body);

}  // namespace pos::estimation
