#pragma once
/// An estimator along a run of dual_uwb_runs.hpp, judged against the formula.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>
#include <vector>

#include "pos/estimation/factory.hpp"
#include "support/dual_uwb_runs.hpp"

namespace pos::testing {

/// Errors from `from` seconds on, asked whenever the stamp moves on after ranges.
inline DualUwbScore scored(const estimation::DualUwbConfig& config, const DualUwbSite& site,
                           const ArcDrive& drive, const std::vector<Measurement>& log, double from = 3.0) {
  const auto estimator = estimation::makeEstimator(config, dualUwbMap(site));
  DualUwbScore score;
  int turning = 0;
  const auto judge = [&](Stamp stamp) {
    const double t = seconds(stamp - dualStamp(0.0));
    const auto estimate = estimator->estimateAt(stamp);
    if (t < from || !estimate) return;
    const ArcDrive::State truth = drive.at(t);
    const Vector<3> e = minus(estimate->T_map_body.planar(), truth.pose);
    score.x += e[0] * e[0];
    score.y += e[1] * e[1];
    score.yaw += e[2] * e[2];
    if (truth.yaw_rate != 0.0) {
      score.yaw_turning += e[2] * e[2];
      ++turning;
    }
    score.x_max = std::max(score.x_max, std::abs(e[0]));
    score.y_max = std::max(score.y_max, std::abs(e[1]));
    score.yaw_max = std::max(score.yaw_max, std::abs(e[2]));
    score.nees += e.dot(estimate->planarCovariance().llt().solve(e));
    if (estimate->twist) {
      score.speed += std::pow(estimate->twist->rates[0] - truth.speed, 2);
      score.rate += std::pow(estimate->twist->rates[2] - truth.yaw_rate, 2);
    }
    ++score.answers;
  };
  bool ranged = false;
  for (std::size_t i = 0; i < log.size(); ++i) {
    (void)estimator->ingest(log[i]);
    ranged = ranged || std::holds_alternative<BeaconRange>(log[i].reading);
    if (i + 1 < log.size() && log[i + 1].stamp == log[i].stamp) continue;
    if (ranged) judge(log[i].stamp);
    ranged = false;
  }
  const double n = std::max(score.answers, 1);
  for (double* sum : {&score.x, &score.y, &score.yaw, &score.speed, &score.rate}) *sum = std::sqrt(*sum / n);
  score.yaw_turning = std::sqrt(score.yaw_turning / std::max(turning, 1));
  score.nees /= n;
  return score;
}

/// Root mean square of every rms, mean of every maximum, mean of the NEES.
inline DualUwbScore pooled(const std::vector<DualUwbScore>& scores) {
  DualUwbScore sum;
  for (const DualUwbScore& s : scores) {
    sum.x += s.x * s.x;
    sum.y += s.y * s.y;
    sum.yaw += s.yaw * s.yaw;
    sum.yaw_turning += s.yaw_turning * s.yaw_turning;
    sum.speed += s.speed * s.speed;
    sum.rate += s.rate * s.rate;
    sum.x_max += s.x_max;
    sum.y_max += s.y_max;
    sum.yaw_max += s.yaw_max;
    sum.nees += s.nees;
    sum.answers += s.answers;
  }
  const auto n = static_cast<double>(scores.size());
  for (double* squares : {&sum.x, &sum.y, &sum.yaw, &sum.yaw_turning, &sum.speed, &sum.rate})
    *squares = std::sqrt(*squares / n);
  for (double* total : {&sum.x_max, &sum.y_max, &sum.yaw_max, &sum.nees}) *total /= n;
  return sum;
}

inline DualUwbScore onDoubleLane(const estimation::DualUwbConfig& config, const DualUwbRunOptions& options,
                                 double from = 3.0) {
  const auto site = doubleLaneSite();
  const auto drive = doubleLaneDrive();
  return scored(config, site, drive, dualUwbRun(site, drive, options), from);
}

inline double diagnostic(const estimation::Estimator& estimator, const std::string& name) {
  for (const auto& value : estimator.diagnostics()) {
    if (value.name == name) return value.value;
  }
  ADD_FAILURE() << "no " << name;
  return 0.0;
}

/// Ingests a run; returns the events told, in order.
inline std::vector<std::string> drive(estimation::Estimator& estimator, const std::vector<Measurement>& log) {
  std::vector<std::string> events;
  for (const Measurement& m : log) {
    const IngestReport report = estimator.ingest(m);
    if (!report.event.empty()) events.emplace_back(report.event);
  }
  return events;
}

}  // namespace pos::testing
