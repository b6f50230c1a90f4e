#include "pos/io/rawlog_reader.hpp"

#include <mrpt/obs/CActionCollection.h>

#include <utility>

#include "mrpt_archive.hpp"
#include "mrpt_values.hpp"
#include "object_stream.hpp"
#include "pos/core/error.hpp"
#include "pos/io/log_cache.hpp"
#include "pos/io/mcap_log.hpp"
#include "rawlog_intake.hpp"

namespace pos::io {

using mrpt::serialization::CSerializable;

struct RawlogReader::Impl {
  Impl(const std::string& path, ReadAhead ahead) : intake(mrpt::Clock::now()), objects(path, ahead) {}

  void readOne();
  void stop(const std::string& damage);

  RawlogIntake intake;
  ObjectStream objects;
  LogEnd end;
  bool done = false;
};

void RawlogReader::Impl::stop(const std::string& damage) {
  done = true;
  end.damaged = !damage.empty();
  end.message = damage;
  intake.finish();
}

void RawlogReader::Impl::readOne() {
  ObjectStream::Object* const next = objects.next();
  if (next == nullptr) return stop(objects.damage());
  ++end.objects;
  end.byte = next->byte;
  const CSerializable* object = next->object.get();
  try {
    if (object != nullptr && object->GetRuntimeClass() == CLASS_ID(mrpt::obs::CActionCollection)) {
      intake.hold(std::move(next->object));
    } else {
      intake.take(next->object.get());
    }
  } catch (const std::exception& error) {
    stop(messageOf(error.what()));
  }
}

RawlogReader::RawlogReader(const std::string& path, ReadAhead ahead) {
  registerMrptClasses();
  impl_ = std::make_unique<Impl>(path, ahead);
  impl_->readOne();
  if (impl_->end.objects > 0) return;
  if (!impl_->end.damaged) {
    throw DataError(Complaint{
        .what = "the rawlog is empty", .place = {.file = path}, .suggestion = "record or copy it again"});
  }
  throw DataError(Complaint{
      .what = "this is no MRPT rawlog, or it is damaged from its first object on",
      .place = {.file = path},
      .got = impl_->end.message,
      .expected = "a .rawlog file of MRPT, plain or gzip",
      .suggestion = "check that the path names the log and not a text, map or bag file; copy it again"});
}

RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;
RawlogReader& RawlogReader::operator=(RawlogReader&&) noexcept = default;
RawlogReader::~RawlogReader() = default;

std::optional<Measurement> RawlogReader::next() {
  for (;;) {
    if (auto measurement = impl_->intake.pop()) return measurement;
    if (impl_->done) return std::nullopt;
    impl_->readOne();
  }
}

const LogEnd& RawlogReader::end() const {
  return impl_->end;
}

std::optional<std::size_t> RawlogReader::frame() const {
  return impl_->intake.frame();
}

LogFormat RawlogReader::format() const {
  return impl_->intake.format();
}

const LogTally& RawlogReader::tally() const {
  return impl_->intake.tally();
}

FrameStamps frameStamps(const std::string& path) {
  if (isMcap(path) || isLogCache(path)) {
    throw DataError(
        Complaint{.what = "only a rawlog has the action/observation pairs that a truth by index counts",
                  .place = {.file = path},
                  .suggestion = "name the rawlog itself, or give the truth with stamps (TUM)"});
  }
  RawlogReader log(path);
  RawlogReader::Impl& impl = *log.impl_;
  std::vector<Stamp> stamps;
  const auto collect = [&] {
    if (impl.intake.pairs() == stamps.size()) return;
    if (const auto stamp = impl.intake.pairStamp()) return stamps.push_back(*stamp);
    throw DataError(Complaint{.what = "an action/observation pair has no time stamp in any of its parts",
                              .place = {.file = path},
                              .got = "pair " + std::to_string(stamps.size()) + " (counted from 0)"});
  };
  collect();
  while (!impl.done) {
    impl.readOne();
    collect();
    while (impl.intake.pop()) continue;
  }
  if (stamps.empty()) {
    throw DataError(Complaint{.what = "the log has no action/observation pairs",
                              .place = {.file = path},
                              .suggestion = "place the truth by time instead of by index"});
  }
  return {stamps, !impl.end.damaged};
}

}  // namespace pos::io
