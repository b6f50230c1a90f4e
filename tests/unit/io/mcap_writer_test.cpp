/// The frame of an MCAP file: marks, lengths, checksums. The reference reader looks at the rest (tests/mcap).
#include "pos/io/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "pos/core/error.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value{};
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

std::string written(const ScratchFolder& folder, int messages) {
  McapWriter writer(folder.file("a.mcap"));
  const auto channel = writer.addChannel("/a", {"std_msgs/msg/Float64", "float64 data\n"});
  for (int i = 0; i < messages; ++i)
    writer.write(channel, pos::io::at(0.1 * i), std::string("\0\1\0\0", 4) + std::string(8, '\0'));
  writer.attach("run.json", "application/json", "{}", pos::io::at(0.0));
  writer.close();
  return contentOf(folder.file("a.mcap"));
}

/// Opcodes of the records outside chunks, in order.
std::vector<int> recordsOf(const std::string& file) {
  std::vector<int> opcodes;
  std::size_t place = kMagic.size();
  while (place + 9 <= file.size() - kMagic.size()) {
    opcodes.push_back(static_cast<unsigned char>(file[place]));
    place += 9 + at<std::uint64_t>(file, place + 1);
  }
  EXPECT_EQ(place, file.size() - kMagic.size());
  return opcodes;
}

TEST(McapWriter, RecordsFollowEachOtherBetweenTheMarks) {
  const ScratchFolder folder;
  const std::string file = written(folder, 3);
  EXPECT_EQ(file.substr(0, 8), kMagic);
  EXPECT_EQ(file.substr(file.size() - 8), kMagic);
  // header, attachment, chunk, message index, data end; schema, channel, statistics, chunk index, attachment
  // index, five summary offsets, footer
  EXPECT_EQ(recordsOf(file), (std::vector<int>{1, 9, 6, 7, 15, 3, 4, 11, 8, 10, 14, 14, 14, 14, 14, 2}));
}

TEST(McapWriter, TheSummarysChecksumCoversItAndTheFooter) {
  const ScratchFolder folder;
  const std::string file = written(folder, 3);
  const std::size_t crc_place = file.size() - kMagic.size() - 4;
  const auto start = at<std::uint64_t>(file, crc_place - 16);
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  EXPECT_EQ(at<std::uint32_t>(file, crc_place), crc32_z(0, bytes + start, crc_place - start));
}

TEST(McapWriter, ManyMessagesMakeSeveralChunks) {
  const ScratchFolder folder;
  const auto records = recordsOf(written(folder, 60'000));
  EXPECT_EQ(std::count(records.begin(), records.end(), 6), 3);
}

TEST(McapWriter, AFolderThatIsNotThereIsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(McapWriter(folder.file("no/such/a.mcap")), DataError);
}

}  // namespace
}  // namespace pos::io
