#include "rawlog_encoder.hpp"

#include <mrpt/obs/CObservationComment.h>

#include "mrpt_values.hpp"

namespace pos::io {
namespace {

std::string labelOf(const Measurement& measurement) {
  return measurement.sensor.empty() ? std::string(readingName(measurement.reading)) : measurement.sensor;
}

}  // namespace

void RawlogEncoder::put(Stamp stamp, const std::string& label, const Stored& stored) {
  if (stored.companion) {
    mrpt::obs::CObservationComment comment;
    comment.timestamp = stampToMrpt(stamp);
    comment.text = stored.companion->text();
    archive_ << comment;
  }
  stored.carrier->timestamp = stampToMrpt(stamp);
  stored.carrier->sensorLabel = label;
  archive_ << *stored.carrier;
}

void RawlogEncoder::putOdometry(Stamp stamp, const std::string& label, const OdometryIncrement& reading) {
  Total& total = totals_[label];
  const auto rounded = [](Stamp t) { return *stampFromMrpt(stampToMrpt(t)); };
  if (!total.referenced) {
    total.stamp = rounded(stamp - reading.interval.value_or(Duration{0}));
    total.referenced = true;
    put(total.stamp, label, {absoluteOdometry(total.pose), {}});
  }
  Companion extra("odometry");
  const Stamp now = rounded(stamp);
  const Duration since = now - total.stamp;
  const std::optional<Duration> implied = since.count() > 0 ? std::optional(since) : std::nullopt;
  if (reading.covariance || reading.interval != implied) {
    // A line is complete: what it does not say is absent.
    if (reading.interval) extra.putInteger("interval_ns", reading.interval->count());
    if (reading.covariance) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = *reading.covariance;
      extra.put("covariance", std::vector<double>(rows.data(), rows.data() + rows.size()));
    }
    if (extra.empty()) extra.putWord("interval", "unknown");
  }
  total.pose = total.pose * reading.increment;
  total.stamp = now;
  put(stamp, label, {absoluteOdometry(total.pose), extra.empty() ? std::nullopt : std::optional(extra)});
}

void RawlogEncoder::put(const Measurement& measurement) {
  const std::string label = labelOf(measurement);
  if (const auto* odometry = std::get_if<OdometryIncrement>(&measurement.reading)) {
    putOdometry(measurement.stamp, label, *odometry);
  } else if (const auto* ticks = std::get_if<WheelTicks>(&measurement.reading)) {
    put(measurement.stamp, label, stored(*ticks, totals_[label].pose));
  } else if (const auto* speeds = std::get_if<WheelSpeeds>(&measurement.reading)) {
    put(measurement.stamp, label, stored(*speeds, totals_[label].pose));
  } else {
    const Stored result = stored(Measurement{measurement.stamp, label, measurement.reading});
    put(measurement.stamp, result.carrier->sensorLabel, result);
  }
}

}  // namespace pos::io
