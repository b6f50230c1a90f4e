#include "calibrate_ranges.hpp"

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/eval/association.hpp"
#include "pos/io/log_reader.hpp"
#include "pos/uwb/motion_calibration.hpp"

namespace pos::app {
namespace {

using estimation::DualUwbConfig;

const DualUwbConfig& wantedConfig(const io::RunConfig& config, const std::string& name) {
  for (const io::EstimatorEntry& entry : config.estimators) {
    const auto* dual = std::get_if<DualUwbConfig>(&entry.config);
    if (dual != nullptr && (name.empty() || entry.name == name)) return *dual;
  }
  throw UsageError(Complaint{.what = "the configuration has no such estimator of type dual_uwb",
                             .key = "--estimator",
                             .got = name,
                             .suggestion = "its list of tags says where the tags sit"});
}

/// The known pose at a moment, inside the window asked for.
class KnownPoses {
 public:
  KnownPoses(const Inputs& inputs, const RangeCalibrationRequest& request)
      : truth_(inputs.truth ? &*inputs.truth : nullptr),
        still_(request.still),
        gap_(durationFromSeconds(inputs.config.evaluation.max_gap)),
        first_(durationFromSeconds(request.first)) {
    if (!still_ && (truth_ == nullptr || truth_->poses.empty())) {
      throw DataError(
          Complaint{.what = "there are no known poses to calibrate against",
                    .key = "--truth",
                    .suggestion = "give surveyed poses with --truth, or --still X_M Y_M YAW_DEG"});
    }
    if (!still_ && !truth_->has_yaw) {
      throw DataError(Complaint{.what = "the known poses have no heading, so the tags' places are not known",
                                .key = "--truth"});
    }
  }

  std::optional<Pose2> at(Stamp stamp) {
    if (!begin_) begin_ = still_ ? stamp : truth_->poses.front().stamp;
    if (first_ > Duration{0} && stamp >= *begin_ + first_) return std::nullopt;
    if (still_) return still_;
    const auto pose = eval::interpolate(*truth_, stamp, gap_);
    return pose ? std::optional(pose->planar()) : std::nullopt;
  }

  /// The poses themselves, for how the vehicle moves.
  std::vector<uwb::TimedPose> all() const {
    std::vector<uwb::TimedPose> poses;
    if (still_) return poses;
    const Stamp end = truth_->poses.front().stamp + first_;
    for (const TruthPose& pose : truth_->poses) {
      if (first_ > Duration{0} && pose.stamp >= end) break;
      poses.push_back({pose.stamp, pose.T_map_body.planar()});
    }
    return poses;
  }

 private:
  const Truth* truth_;
  std::optional<Pose2> still_;
  Duration gap_;
  Duration first_;
  std::optional<Stamp> begin_;
};

std::optional<Eigen::Vector3d> mountOf(const DualUwbConfig& config, const BeaconRange& range) {
  for (const estimation::TagMount& tag : config.tags) {
    if (tag.id == range.tag) return tag.p_body;
  }
  return range.tag_body;
}

std::vector<uwb::CalibrationSample> samplesOf(const Inputs& inputs, const DualUwbConfig& config,
                                              KnownPoses& poses) {
  std::vector<uwb::CalibrationSample> samples;
  const auto reader = io::openLog(inputs.config.log->file.string()).reader;
  while (const auto m = reader->next()) {
    const auto* range = std::get_if<BeaconRange>(&m->reading);
    if (range == nullptr || defect(*m)) continue;
    const map::Anchor* anchor = inputs.map->findAnchor(range->anchor);
    const auto mount = mountOf(config, *range);
    if (anchor == nullptr || !mount) continue;
    const auto pose = poses.at(m->stamp);
    if (!pose) continue;
    samples.push_back({m->stamp, range->tag, range->anchor, *mount, anchor->p_map, *pose, config.body_height,
                       range->range - anchor->range_bias});
  }
  if (samples.empty()) {
    throw DataError(
        Complaint{.what = "no range was taken at a known pose",
                  .place = {.file = inputs.config.log->file.string()},
                  .suggestion = "check that log and poses share a clock, and the window --first-s"});
  }
  return samples;
}

}  // namespace

RangeCalibrationOutcome calibratedRanges(const Inputs& inputs, const RangeCalibrationRequest& request) {
  const DualUwbConfig& config = wantedConfig(inputs.config, request.estimator);
  KnownPoses poses(inputs, request);
  const auto samples = samplesOf(inputs, config, poses);
  // a vehicle that stands sees every anchor from one side: nothing tells a shift from the biases
  const double shift_sigma = request.still ? 0.0 : request.shift_sigma;
  const auto found = uwb::calibratedRanges(samples, {.shift_sigma = shift_sigma});
  RangeCalibrationOutcome outcome;
  outcome.residual_sigma = found.residual_sigma;
  outcome.samples = found.samples;
  outcome.outliers = found.outliers;
  outcome.table.source = inputs.config.log->file.filename().string();
  for (const uwb::LinkCalibration& link : found.links) {
    outcome.table.links.push_back({{link.tag, link.anchor, link.bias},
                                   link.bias_sigma,
                                   link.residual_sigma,
                                   link.samples,
                                   link.outliers});
  }
  for (const uwb::TagCalibration& tag : found.tags) {
    outcome.table.tag_shifts.push_back({tag.tag, tag.shift.x(), tag.shift.y()});
  }
  outcome.table.errors =
      io::CalibratedErrors{found.errors.reading_sigma, found.errors.lasting_sigma, found.errors.lasting_time};
  const uwb::MotionCalibration motion = uwb::calibratedMotion(poses.all());
  if (motion.samples > 0) {
    outcome.table.motion = io::CalibratedMotion{motion.centre_x, motion.course_offset,
                                                motion.acceleration_density, motion.yaw_acceleration_density};
  }
  return outcome;
}

}  // namespace pos::app
