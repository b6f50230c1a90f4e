#include "pos/io/rawlog_writer.hpp"

#include <mrpt/obs/CObservationComment.h>

#include <map>
#include <stdexcept>

#include "mrpt_archive.hpp"
#include "mrpt_conversion.hpp"
#include "mrpt_values.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

std::string labelOf(const Measurement& measurement) {
  return measurement.sensor.empty() ? std::string(readingName(measurement.reading)) : measurement.sensor;
}

}  // namespace

struct RawlogWriter::Impl {
  /// What the sensor's absolute odometry says after its last record.
  struct Total {
    Pose2 pose;
    Stamp stamp;
    bool referenced = false;
  };

  Impl(std::string file, int level) : path(std::move(file)), archive(path, level) {}

  void put(const Measurement& measurement);
  void put(Stamp stamp, const std::string& label, const Stored& stored);
  void putOdometry(Stamp stamp, const std::string& label, const OdometryIncrement& reading);

  std::string path;
  GzipArchive archive;
  std::map<std::string, Total> totals;
};

void RawlogWriter::Impl::put(Stamp stamp, const std::string& label, const Stored& stored) {
  if (stored.companion) {
    mrpt::obs::CObservationComment comment;
    comment.timestamp = stampToMrpt(stamp);
    comment.text = stored.companion->text();
    archive << comment;
  }
  stored.carrier->timestamp = stampToMrpt(stamp);
  stored.carrier->sensorLabel = label;
  archive << *stored.carrier;
}

void RawlogWriter::Impl::putOdometry(Stamp stamp, const std::string& label,
                                     const OdometryIncrement& reading) {
  Total& total = totals[label];
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

void RawlogWriter::Impl::put(const Measurement& measurement) {
  const std::string label = labelOf(measurement);
  if (const auto* odometry = std::get_if<OdometryIncrement>(&measurement.reading)) {
    putOdometry(measurement.stamp, label, *odometry);
  } else if (const auto* ticks = std::get_if<WheelTicks>(&measurement.reading)) {
    put(measurement.stamp, label, stored(*ticks, totals[label].pose));
  } else if (const auto* speeds = std::get_if<WheelSpeeds>(&measurement.reading)) {
    put(measurement.stamp, label, stored(*speeds, totals[label].pose));
  } else {
    const Stored result = stored(Measurement{measurement.stamp, label, measurement.reading});
    put(measurement.stamp, result.carrier->sensorLabel, result);
  }
}

RawlogWriter::RawlogWriter(const std::string& path, const RawlogWriterConfig& config) {
  if (config.gzip_level < 0 || config.gzip_level > 9) {
    throw ConfigError(Complaint{.what = "the compression level of the rawlog is out of range",
                                .key = "gzip_level",
                                .got = std::to_string(config.gzip_level),
                                .expected = "0 to 9"});
  }
  impl_ = std::make_unique<Impl>(path, config.gzip_level);
  if (!impl_->archive.isOpen()) {
    throw DataError(Complaint{.what = "the rawlog cannot be created",
                              .place = {.file = path},
                              .suggestion = "check that its folder exists and that you may write there"});
  }
}

RawlogWriter::RawlogWriter(RawlogWriter&&) noexcept = default;
RawlogWriter& RawlogWriter::operator=(RawlogWriter&&) noexcept = default;
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const Measurement& measurement) {
  ensure(impl_->archive.isOpen(), "a closed rawlog cannot be written to");
  if (const auto reason = defect(measurement)) {
    throw DataError(Complaint{.what = "a defective measurement is not written",
                              .place = {.file = impl_->path},
                              .key = measurement.sensor,
                              .got = *reason});
  }
  try {
    impl_->put(measurement);
  } catch (const std::runtime_error&) {
    throw DataError(Complaint{.what = "the rawlog could not be written to its end",
                              .place = {.file = impl_->path},
                              .suggestion = "check that the disk is not full"});
  }
}

void RawlogWriter::close() {
  if (impl_->archive.close()) return;
  throw DataError(Complaint{.what = "the rawlog could not be written to its end",
                            .place = {.file = impl_->path},
                            .suggestion = "check that the disk is not full"});
}

}  // namespace pos::io
