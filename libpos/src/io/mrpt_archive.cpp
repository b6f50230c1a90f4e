#include "mrpt_archive.hpp"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/registerAllClasses.h>

#include <cstring>

#include "mrpt_values.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

DataError notA(const std::string& path, const std::string& wanted, const std::string& got) {
  return DataError(Complaint{.what = "this file does not hold the map that is asked for",
                             .place = {.file = path},
                             .got = got,
                             .expected = "one object of MRPT's class " + wanted,
                             .suggestion = "check the path; export or copy the map again"});
}

/// The class of the next object without building it, cleaned for printing.
std::string nextClass(ByteSource& source) {
  const auto head = source.peek(128);
  if (head.empty()) return "an empty file";
  const std::size_t skip = (head[0] & 0x80U) != 0 ? 1 : 4;
  const std::size_t length = head[0] & 0x7FU;
  if (head.size() < skip + length) return "something else";
  std::string name(reinterpret_cast<const char*>(head.data()) + skip, length);
  return sanitised(name);
}

}  // namespace

void registerMrptClasses() {
  static const bool kDone = [] {
    mrpt::obs::registerAllClasses_mrpt_obs();
    mrpt::maps::registerAllClasses_mrpt_maps();
    return true;
  }();
  static_cast<void>(kDone);
}

mrpt::serialization::CSerializable::Ptr readMapObject(const std::string& path, const std::string& wanted) {
  registerMrptClasses();
  ByteSource source(path);
  const std::string name = nextClass(source);
  const std::string bare = wanted.substr(wanted.rfind(':') + 1);
  if (name != wanted && name != bare) throw notA(path, wanted, name);
  SourceArchive archive(source);
  try {
    auto object = archive.ReadObject();
    source.atEnd();
    if (source.damage()) throw std::runtime_error(*source.damage());
    return object;
  } catch (const std::exception& error) {
    throw notA(path, wanted, "a damaged one: " + source.damage().value_or(messageOf(error.what())));
  }
}

void writeMapObject(const mrpt::serialization::CSerializable& object, const std::string& path) {
  GzipArchive archive(path, 6);
  const auto failed = [&path](const char* what) {
    return DataError(Complaint{.what = what,
                               .place = {.file = path},
                               .suggestion = "check that the folder exists and the disk is not full"});
  };
  if (!archive.isOpen()) throw failed("the map file cannot be created");
  try {
    archive << object;
  } catch (const std::runtime_error&) {
    throw failed("the map file could not be written to its end");
  }
  if (!archive.close()) throw failed("the map file could not be written to its end");
}

}  // namespace pos::io
