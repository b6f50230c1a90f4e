#include "pos/yardstick/factory.hpp"

#include "pos/yardstick/mrpt_mcl.hpp"

namespace pos::yardstick {

std::unique_ptr<estimation::Estimator> makeAnyEstimator(const estimation::EstimatorConfig& config,
                                                        std::shared_ptr<const map::TunnelMap> map) {
  if (const auto* mrpt = std::get_if<estimation::MrptMclConfig>(&config))
    return std::make_unique<MrptMcl>(*mrpt, std::move(map));
  return estimation::makeEstimator(config, std::move(map));
}

}  // namespace pos::yardstick
