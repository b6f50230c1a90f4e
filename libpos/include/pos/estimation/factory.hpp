#pragma once
/// The one place where a configuration becomes an estimator.

#include <memory>
#include <string_view>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// The `type:` of a configuration: "dead_reckoning", "range_odometry", "mcl", "mrpt_mcl", "dual_uwb",
/// "sins_dr", "uwb_imu", "seamless", "shearer".
std::string_view typeName(const EstimatorConfig& config);

/// A ready estimator. Throws ConfigError when the map lacks what it needs (anchors, grid), and ContractError
/// for `mrpt_mcl`, which lives in module `yardstick` (pos/yardstick/factory.hpp makes every type).
std::unique_ptr<Estimator> makeEstimator(const EstimatorConfig& config,
                                         std::shared_ptr<const map::TunnelMap> map);

}  // namespace pos::estimation
