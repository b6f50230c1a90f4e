#include "object_stream.hpp"

#include <utility>

#include "mrpt_values.hpp"
#include "object_guard.hpp"
#include "quick_objects.hpp"

namespace pos::io {
namespace {

constexpr std::size_t kBatchObjects = 256;
constexpr std::uint64_t kBatchBytes = std::uint64_t{1} << 18U;  // uncompressed; scans and images are large
constexpr std::size_t kMostReady = 8;                           // batches

}  // namespace

ObjectStream::ObjectStream(const std::string& path, ReadAhead ahead) : source_(path), archive_(source_) {
  if (ahead == ReadAhead::Yes) thread_.emplace([this] { work(); });
}

ObjectStream::~ObjectStream() {
  if (!thread_) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_->join();
}

ObjectStream::Object* ObjectStream::next() {
  while (at_ == current_.filled) {
    if (current_.last) return nullptr;
    fetch();
  }
  return &current_.objects[at_++];
}

void ObjectStream::fetch() {
  at_ = 0;
  if (!thread_) return fill(current_, 1);
  {
    std::unique_lock lock(mutex_);
    used_.push_back(std::move(current_));
    changed_.wait(lock, [this] { return !ready_.empty(); });
    current_ = std::move(ready_.front());
    ready_.pop_front();
  }
  changed_.notify_all();
}

void ObjectStream::work() {
  for (bool last = false; !last;) {
    Batch batch;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || ready_.size() < kMostReady; });
      if (stop_) return;
      if (!used_.empty()) {
        batch = std::move(used_.front());
        used_.pop_front();
      }
    }
    fill(batch, kBatchObjects);
    last = batch.last;
    {
      const std::lock_guard lock(mutex_);
      ready_.push_back(std::move(batch));
    }
    changed_.notify_all();
  }
}

void ObjectStream::fill(Batch& batch, std::size_t most) {
  batch.filled = 0;
  const std::uint64_t begin = source_.position();
  while (batch.filled < most && source_.position() - begin < kBatchBytes) {
    if (!readOne(batch)) return;
  }
}

/// False at the end of the readable part.
bool ObjectStream::readOne(Batch& batch) {
  const auto stop = [&](const std::string& damage) {
    batch.last = true;
    batch.damage = damage;
    return false;
  };
  if (source_.atEnd()) return stop(source_.damage().value_or(""));
  if (batch.filled == batch.objects.size()) batch.objects.emplace_back();
  Object& next = batch.objects[batch.filled];
  try {
    if (const std::size_t length = readQuickly(source_.peek(kQuickWindow), next.object); length > 0) {
      source_.skip(length);
      next.byte = source_.position();
      ++batch.filled;
      return true;
    }
    if (const auto outline = outlineNext(source_); outline.damage)
      return stop(source_.damage().value_or(*outline.damage));
    next = {archive_.ReadObject(), source_.position()};
    ++batch.filled;
  } catch (const std::exception& error) {
    return stop(source_.damage().value_or(messageOf(error.what())));
  }
  return true;
}

}  // namespace pos::io
