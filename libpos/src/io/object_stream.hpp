#pragma once
/// The objects of a rawlog one after the other, taken out of the file by the caller or by a thread ahead of
/// it. Private to io.

#include <mrpt/serialization/CSerializable.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "byte_source.hpp"
#include "mrpt_archive.hpp"
#include "pos/io/rawlog_reader.hpp"

namespace pos::io {

class ObjectStream {
 public:
  /// Throws DataError when the file is missing, a folder, or cannot be opened.
  ObjectStream(const std::string& path, ReadAhead ahead);
  ObjectStream(const ObjectStream&) = delete;
  ObjectStream& operator=(const ObjectStream&) = delete;
  ~ObjectStream();

  struct Object {
    mrpt::serialization::CSerializable::Ptr object;  ///< null for an empty place in the log
    std::uint64_t byte = 0;                          ///< of the uncompressed stream, behind the object
  };
  /// The next object, the caller's until the call after; null at the end of the readable part.
  Object* next();
  /// Why reading ended, empty for a clean end; valid once next() returned null.
  const std::string& damage() const { return current_.damage; }

 private:
  /// Objects change hands by the batch. A used batch goes back, so that the thread that made the objects
  /// frees them or fills them again.
  struct Batch {
    std::vector<Object> objects;
    std::size_t filled = 0;  ///< the first so many of `objects`
    bool last = false;
    std::string damage;
  };

  void fill(Batch& batch, std::size_t most);
  bool readOne(Batch& batch);
  void work();
  void fetch();

  ByteSource source_;
  SourceArchive archive_;

  Batch current_;
  std::size_t at_ = 0;

  // Between the two threads.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> ready_;
  std::deque<Batch> used_;
  bool stop_ = false;
  std::optional<std::thread> thread_;
};

}  // namespace pos::io
