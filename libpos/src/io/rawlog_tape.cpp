#include "pos/io/rawlog_tape.hpp"

#include <cstring>
#include <utility>

#include "mrpt_archive.hpp"
#include "pos/core/error.hpp"
#include "rawlog_encoder.hpp"
#include "rawlog_intake.hpp"

namespace pos::io {
namespace {

/// Written at the end, read from the front.
class MemoryArchive final : public mrpt::serialization::CArchive {
 public:
  std::string take() {
    read_ = 0;
    return std::exchange(bytes_, {});
  }
  bool atEnd() const { return read_ == bytes_.size(); }

 protected:
  std::size_t write(const void* data, std::size_t count) override {
    bytes_.append(static_cast<const char*>(data), count);
    return count;
  }
  std::size_t read(void* target, std::size_t count) override {
    if (bytes_.size() - read_ < count) throw ContractError("a taped object is not whole");
    std::memcpy(target, bytes_.data() + read_, count);
    read_ += count;
    return count;
  }

 private:
  std::string bytes_;
  std::size_t read_ = 0;
};

}  // namespace

struct RawlogTape::Impl {
  MemoryArchive archive;
  RawlogEncoder encoder{archive};
  /// Live stamps may be later than the moment this began, and none of them was made up.
  RawlogIntake intake{mrpt::Clock::time_point::max()};
};

RawlogTape::RawlogTape() {
  registerMrptClasses();
  impl_ = std::make_unique<Impl>();
}

RawlogTape::RawlogTape(RawlogTape&&) noexcept = default;
RawlogTape& RawlogTape::operator=(RawlogTape&&) noexcept = default;
RawlogTape::~RawlogTape() = default;

Taped RawlogTape::take(const Measurement& measurement) {
  if (const auto reason = defect(measurement)) {
    throw DataError(Complaint{
        .what = "a defective measurement is not recorded", .key = measurement.sensor, .got = *reason});
  }
  impl_->encoder.put(measurement);
  while (!impl_->archive.atEnd()) impl_->intake.take(impl_->archive.ReadObject().get());
  Taped taped{.bytes = impl_->archive.take()};
  while (auto read = impl_->intake.pop()) taped.read_back.push_back(std::move(*read));
  return taped;
}

}  // namespace pos::io
