#pragma once
/// The factory of all estimators, MRPT's among them.

#include "pos/estimation/factory.hpp"

namespace pos::yardstick {

/// As estimation::makeEstimator, and `mrpt_mcl` too.
std::unique_ptr<estimation::Estimator> makeAnyEstimator(const estimation::EstimatorConfig& config,
                                                        std::shared_ptr<const map::TunnelMap> map);

}  // namespace pos::yardstick
