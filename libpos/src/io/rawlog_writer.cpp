#include "pos/io/rawlog_writer.hpp"

#include <stdexcept>

#include "mrpt_archive.hpp"
#include "pos/core/error.hpp"
#include "rawlog_encoder.hpp"
#include "sound.hpp"

namespace pos::io {

struct RawlogWriter::Impl {
  Impl(std::string file, int level) : path(std::move(file)), archive(path, level) {}

  std::string path;
  GzipArchive archive;
  RawlogEncoder encoder{archive};
};

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
  requireSound(measurement, impl_->path);
  try {
    impl_->encoder.put(measurement);
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
