#include "pos/lidar/leg_association.hpp"

#include <limits>
namespace pos::lidar {
namespace {

LegAssociation nearest(const Eigen::Vector2d& p, std::span<const PredictedLeg> predictions, double gate) {
  LegAssociation answer{.distance = std::numeric_limits<double>::infinity()};
  int within = 0;
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const double distance = (predictions[i].p - p).norm();
    if (distance <= gate) ++within;
    if (distance < answer.distance) {
      answer.distance = distance;
      answer.predicted = static_cast<int>(i);
    }
  }
  if (within == 1) answer.match = LegMatch::Matched;
  if (within > 1) answer.match = LegMatch::Ambiguous;
  return answer;
}

}  // namespace

std::span<const LegAssociation> LegMatcher::match(std::span<const Eigen::Vector2d> detections,
                                                  std::span<const PredictedLeg> predictions) {
  answers_.clear();
  for (const Eigen::Vector2d& p : detections) {
    const LegAssociation answer = nearest(p, predictions, gate_);
    answers_.push_back(answer);
    if (answer.match == LegMatch::Far) continue;
    for (std::size_t j = 0; j + 1 < answers_.size(); ++j) {
      if (answers_[j].match == LegMatch::Far || answers_[j].predicted != answer.predicted) continue;
      answers_[j].match = LegMatch::Contested;
      answers_.back().match = LegMatch::Contested;
    }
  }
  return answers_;
}

std::vector<LegAssociation> associated(std::span<const Eigen::Vector2d> detections,
                                       std::span<const PredictedLeg> predictions, double gate) {
  LegMatcher matcher(gate);
  const std::span<const LegAssociation> answers = matcher.match(detections, predictions);
  return {answers.begin(), answers.end()};
}

}  // namespace pos::lidar
