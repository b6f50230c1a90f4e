#pragma once
/// Poses side by side while mirror images, or whole headings, cannot be told apart.

#include "pos/estimation/dual_uwb_models.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/hypotheses.hpp"

namespace pos::estimation {

using DualUwbHypothesis = Hypothesis<DualUwbState>;
using DualUwbBank = HypothesisBank<DualUwbState>;

/// Covariance about `best` of a mixture: to be summed over its parts, weights adding to one. Position and
/// heading spread apart from each other, since a heading that may be the opposite one has no sign.
Matrix<3, 3> spreadAbout(const Pose2& best, const Belief<Pose2>& part, double weight);

/// Place of a pose that is not the best one, for the diagnostics: mirror images are told, not averaged.
/// `number` counts from 1.
Diagnostics alternative(int number, const Belief<Pose2>& pose);

}  // namespace pos::estimation
