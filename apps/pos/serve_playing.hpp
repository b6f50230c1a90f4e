#pragma once
/// A pass whose words go to the stage at once.

#include "pass.hpp"
#include "pos/serve/connections.hpp"
#include "serve_stage.hpp"

namespace pos::app {

/// Which moment of the monitor's clock it is when an estimator answers.
using Moment = std::function<Duration(const Measurement&)>;

/// The pass of `inputs`, told to `stage` and `monitor`, which outlive it. The connections judge by the first
/// estimator.
std::unique_ptr<Pass> passOnStage(const Inputs& inputs, const io::RunFolder* folder, Stage& stage,
                                  serve::ConnectionMonitor& monitor, const Moment& moment);

/// Model probabilities of all estimators; now and then is often enough.
void showModes(Pass& pass, Stage& stage);

}  // namespace pos::app
