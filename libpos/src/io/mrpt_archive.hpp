#pragma once
/// MRPT archives over our own byte streams. Private to io.

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "byte_source.hpp"

namespace pos::io {

/// Refuses to give fewer bytes than asked for: MRPT would go on with rubbish.
class SourceArchive final : public mrpt::serialization::CArchive {
 public:
  explicit SourceArchive(ByteSource& source) : source_(source) {}

 protected:
  std::size_t read(void* target, std::size_t count) override {
    if (source_.read(target, count) < count) throw std::runtime_error("the file ends inside an object");
    return count;
  }
  std::size_t write(const void*, std::size_t) override {
    throw std::runtime_error("this archive only reads");
  }

 private:
  ByteSource& source_;
};

/// Writes a gzip file.
class GzipArchive final : public mrpt::serialization::CArchive {
 public:
  GzipArchive(const std::string& path, int level)
      : file_(gzopen(path.c_str(), ("wb" + std::to_string(level)).c_str())) {}
  GzipArchive(const GzipArchive&) = delete;
  GzipArchive& operator=(const GzipArchive&) = delete;
  ~GzipArchive() override { close(); }

  bool isOpen() const { return file_ != nullptr; }
  /// False when not everything reached the disk.
  bool close() {
    const bool good = file_ == nullptr || gzclose_w(file_) == Z_OK;
    file_ = nullptr;
    return good;
  }

 protected:
  std::size_t read(void*, std::size_t) override { throw std::runtime_error("this archive only writes"); }
  std::size_t write(const void* data, std::size_t count) override {
    return static_cast<std::size_t>(std::max(0, gzwrite(file_, data, static_cast<unsigned>(count))));
  }

 private:
  gzFile file_;
};

/// The one object of a map file. Throws DataError naming `wanted` when it is another class or damaged.
mrpt::serialization::CSerializable::Ptr readMapObject(const std::string& path, const std::string& wanted);
/// Throws DataError when the file cannot be written.
void writeMapObject(const mrpt::serialization::CSerializable& object, const std::string& path);

/// MRPT's classes of mrpt-obs and mrpt-maps, known to its archives from now on.
void registerMrptClasses();

}  // namespace pos::io
