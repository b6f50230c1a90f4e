#include "pos/io/run_geojson.hpp"

#include <fstream>
#include <functional>
#include <utility>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"
#include "pos/map/geodesy.hpp"
#include "quoted.hpp"
#include "run_files.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

/// Gives every point of a track to the taker; called once for the places and once for the stamps, so that no
/// track is held in memory.
using Taker = std::function<void(Stamp, const Eigen::Vector3d&)>;
using Track = std::function<void(const Taker&)>;

class TrackFile {
 public:
  TrackFile(const fs::path& path, const TrackOptions& options) : path_(path), file_(path, std::ios::binary) {
    if (options.origin) frame_.emplace(*options.origin);
    if (!file_)
      throw DataError(Complaint{.what = "the file cannot be written", .place = {.file = path.string()}});
    file_ << R"({"type": "FeatureCollection", "features": [)";
  }

  std::uint64_t write(const std::string& name, const char* kind, const Track& track) {
    std::uint64_t count = 0;
    track([&](Stamp, const Eigen::Vector3d&) { ++count; });
    file_ << (std::exchange(first_, false) ? "\n" : ",\n") << R"({"type": "Feature", "geometry": )";
    if (count == 0) {
      file_ << "null";
    } else {
      // A line has two points at least.
      file_ << (count == 1 ? R"({"type": "Point", "coordinates": )"
                           : R"({"type": "LineString", "coordinates": [)");
      const char* between = "";
      track([&](Stamp, const Eigen::Vector3d& p) { file_ << std::exchange(between, ", ") << position(p); });
      file_ << (count == 1 ? "}" : "]}");
    }
    file_ << R"(, "properties": {"object": "track", "name": )" << quoted(name) << R"(, "kind": ")" << kind
          << R"(", "stamps_s": [)";
    const char* between = "";
    track([&](Stamp stamp, const Eigen::Vector3d&) {
      file_ << std::exchange(between, ", ") << text::stampSeconds(stamp);
    });
    file_ << "]}}";
    return count;
  }

  void close() {
    file_ << "\n]}\n";
    file_.close();
    if (!file_)
      throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
  }

 private:
  std::string position(const Eigen::Vector3d& p) const {
    const auto together = [](double a, double b, double c, int decimals) {
      return "[" + text::fixed(a, decimals) + ", " + text::fixed(b, decimals) + ", " + text::fixed(c, 3) +
             "]";
    };
    if (!frame_) return together(p.x(), p.y(), p.z(), 3);
    const map::GeodeticOrigin at = frame_->toGeodetic(p);
    return together(degrees(at.longitude), degrees(at.latitude), at.altitude, 9);  // 0.1 mm
  }

  fs::path path_;
  std::ofstream file_;
  std::optional<map::LocalFrame> frame_;
  bool first_ = true;
};

}  // namespace

std::uint64_t writeRunGeoJson(const fs::path& folder, const fs::path& out, const TrackOptions& options) {
  const std::vector<std::string> names = estimatorsOf(folder);
  TrackFile file(out, options);
  std::uint64_t count = 0;
  for (const std::string& name : names) {
    count += file.write(name, "estimate", [&](const Taker& take) {
      EstimateCsvReader rows(folder / (name + ".csv"));
      while (const auto row = rows.next()) take(row->stamp, row->T_map_body.translation);
    });
  }
  if (options.truth) {
    count += file.write("truth", "truth", [&](const Taker& take) {
      for (const TruthPose& pose : options.truth->poses) take(pose.stamp, pose.T_map_body.translation);
    });
  }
  file.close();
  return count;
}

}  // namespace pos::io
