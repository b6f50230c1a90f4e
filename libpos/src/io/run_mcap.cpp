#include "pos/io/run_mcap.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/files.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/mcap_writer.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"
#include "ros_messages.hpp"
#include "run_files.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

/// One file of the run, row by row: the stamp of the row at hand, and what writes it.
class Stream {
 public:
  virtual ~Stream() = default;
  std::optional<Stamp> stamp;  ///< nothing at the end
  /// Writes the row at hand and goes to the next. Returns the messages written.
  virtual std::uint64_t write(McapWriter& out) = 0;
};

class EstimateStream final : public Stream {
 public:
  /// `frame` is the child frame of the transforms, `topic` the prefix of the topics.
  EstimateStream(const fs::path& csv, const std::string& topic, std::string frame, std::uint16_t tf,
                 McapWriter& out)
      : reader_(csv),
        frame_(std::move(frame)),
        tf_(tf),
        pose_(out.addChannel(topic + "/pose", ros::poseType())),
        odometry_(out.addChannel(topic + "/odometry", ros::odometryType())) {
    advance();
  }
  std::uint64_t write(McapWriter& out) override {
    out.write(tf_, *stamp, ros::transforms(*stamp, row_->T_map_body, frame_));
    out.write(pose_, *stamp, ros::pose(*stamp, row_->T_map_body));
    out.write(odometry_, *stamp, ros::odometry(*row_, frame_));
    advance();
    return 3;
  }

 private:
  void advance() {
    row_ = reader_.next();
    stamp = row_ ? std::optional(row_->stamp) : std::nullopt;
  }
  EstimateCsvReader reader_;
  std::optional<Estimate> row_;
  std::string frame_;
  std::uint16_t tf_, pose_, odometry_;
};

class TruthStream final : public Stream {
 public:
  TruthStream(const Truth& truth, McapWriter& out)
      : truth_(truth), channel_(out.addChannel("/ground_truth/pose", ros::poseType())) {
    advance(0);
  }
  std::uint64_t write(McapWriter& out) override {
    out.write(channel_, *stamp, ros::pose(*stamp, truth_.poses[at_].T_map_body));
    advance(at_ + 1);
    return 1;
  }

 private:
  void advance(std::size_t to) {
    at_ = to;
    stamp = to < truth_.poses.size() ? std::optional(truth_.poses[to].stamp) : std::nullopt;
  }
  const Truth& truth_;
  std::size_t at_ = 0;
  std::uint16_t channel_;
};

class EventStream final : public Stream {
 public:
  EventStream(const fs::path& csv, McapWriter& out)
      : table_(csv), channel_(out.addChannel("/status", ros::statusType())) {
    advance();
  }
  std::uint64_t write(McapWriter& out) override {
    const auto cell = [&](const char* name) { return std::string(table_.cell(table_.column(name))); };
    out.write(channel_, *stamp,
              ros::status({*stamp, cell("estimator"), cell("kind"), cell("sensor"), cell("detail")}));
    advance();
    return 1;
  }

 private:
  void advance() {
    stamp = table_.next()
                ? std::optional(Stamp{table_.duration(table_.column("stamp_s"), text::TimeUnit::Seconds)})
                : std::nullopt;
  }
  CsvReader table_;
  std::uint16_t channel_;
};

Stream* earliest(const std::vector<std::unique_ptr<Stream>>& streams) {
  Stream* first = nullptr;
  for (const auto& stream : streams) {
    if (stream->stamp && (first == nullptr || *stream->stamp < *first->stamp)) first = stream.get();
  }
  return first;
}

void attachFiles(McapWriter& out, const fs::path& folder, const RunExtras& extras, Stamp stamp) {
  for (const char* name : {"run.json", "summary.json"}) {
    if (fs::exists(folder / name)) out.attach(name, "application/json", fileText(folder / name), stamp);
  }
  if (extras.map) out.attach("map.yaml", "application/yaml", mapYaml(*extras.map), stamp);
}

}  // namespace

std::uint64_t writeRunMcap(const fs::path& folder, const fs::path& out, const RunExtras& extras) {
  const std::vector<std::string> names = estimatorsOf(folder);
  McapWriter file(out);
  const std::uint16_t tf = file.addChannel("/tf", ros::transformsType());
  std::vector<std::unique_ptr<Stream>> streams;
  for (const std::string& name : names) {
    const bool alone = names.size() == 1;
    streams.push_back(std::make_unique<EstimateStream>(
        folder / (name + ".csv"), alone ? "/estimate" : "/" + name, alone ? "base_link" : name, tf, file));
  }
  if (extras.truth) streams.push_back(std::make_unique<TruthStream>(*extras.truth, file));
  if (fs::exists(folder / "events.csv"))
    streams.push_back(std::make_unique<EventStream>(folder / "events.csv", file));
  std::uint64_t count = 0;
  if (const Stream* first = earliest(streams); first != nullptr) {
    attachFiles(file, folder, extras, *first->stamp);
    if (extras.map) {
      const auto channel = file.addChannel("/map/markers", ros::markersType());
      file.write(channel, *first->stamp, ros::markers(*first->stamp, *extras.map));
      ++count;
    }
  }
  while (Stream* next = earliest(streams)) count += next->write(file);
  file.close();
  return count;
}

}  // namespace pos::io
