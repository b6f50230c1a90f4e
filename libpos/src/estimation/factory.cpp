#include "pos/estimation/factory.hpp"

#include <array>

#include "pos/core/error.hpp"
#include "pos/estimation/dead_reckoning.hpp"
#include "pos/estimation/dual_uwb_epochs.hpp"
#include "pos/estimation/dual_uwb_filter.hpp"
#include "pos/estimation/mcl.hpp"
#include "pos/estimation/range_odometry.hpp"
#include "pos/estimation/seamless.hpp"
#include "pos/estimation/shearer.hpp"
#include "pos/estimation/shearer_reckoning.hpp"
#include "pos/estimation/sins_dr.hpp"
#include "pos/estimation/uwb_imu.hpp"
#include "pos/estimation/wheel_reckoning.hpp"

namespace pos::estimation {
namespace {

using Map = std::shared_ptr<const map::TunnelMap>;

struct Make {
  Map map;
  std::unique_ptr<Estimator> operator()(const DeadReckoningConfig& c) const {
    if (c.variant != DeadReckoningConfig::Variant::Odometry) return std::make_unique<WheelReckoning>(c, map);
    return std::make_unique<DeadReckoning>(c);
  }
  std::unique_ptr<Estimator> operator()(const RangeOdometryConfig& c) const {
    return std::make_unique<RangeOdometry>(c, map);
  }
  std::unique_ptr<Estimator> operator()(const MclConfig& c) const { return std::make_unique<Mcl>(c, map); }
  std::unique_ptr<Estimator> operator()(const SinsDrConfig& c) const {
    return std::make_unique<SinsDr>(c, map);
  }
  std::unique_ptr<Estimator> operator()(const UwbImuConfig& c) const { return makeUwbImu(c, map); }
  std::unique_ptr<Estimator> operator()(const SeamlessConfig& c) const {
    return std::make_unique<Seamless>(c, map);
  }
  std::unique_ptr<Estimator> operator()(const ShearerConfig& c) const {
    if (c.variant != ShearerConfig::Variant::Lidar) return std::make_unique<ShearerReckoning>(c, map);
    return std::make_unique<Shearer>(c, map);
  }
  std::unique_ptr<Estimator> operator()(const MrptMclConfig&) const {
    throw ContractError("mrpt_mcl is made by pos::yardstick, not by pos::estimation");
  }
  std::unique_ptr<Estimator> operator()(const DualUwbConfig& c) const {
    using Variant = DualUwbConfig::Variant;
    if (c.variant == Variant::Filter || c.variant == Variant::FilterGyro)
      return std::make_unique<DualUwbFilter>(c, map);
    return std::make_unique<DualUwbEpochs>(c, map);
  }
};

}  // namespace

std::string_view typeName(const EstimatorConfig& config) {
  static constexpr std::array<std::string_view, 9> kNames{"dead_reckoning", "range_odometry", "mcl",
                                                          "mrpt_mcl",       "dual_uwb",       "sins_dr",
                                                          "uwb_imu",        "seamless",       "shearer"};
  static_assert(kNames.size() == std::variant_size_v<EstimatorConfig>);
  return kNames[config.index()];
}

std::unique_ptr<Estimator> makeEstimator(const EstimatorConfig& config, Map map) {
  return std::visit(Make{std::move(map)}, config);
}

}  // namespace pos::estimation
