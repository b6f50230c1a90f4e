#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "pos/core/error.hpp"
#include "pos/io/grid_io.hpp"

namespace pos::io {
namespace {

using map::OccupancyGrid;

struct RosHeader {
  std::string image;
  double resolution = 0.0;
  Pose2 origin;
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  bool scale = false;
};

FilePlace placeOf(const std::string& path, const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  return {.file = path, .line = mark.line + 1, .column = mark.column + 1};
}

template <typename T>
T valueOf(const std::string& path, const YAML::Node& root, const char* key, const char* expected) {
  const YAML::Node node = root[key];
  if (!node) {
    throw ConfigError(Complaint{.what = "a key is missing in the ROS map file",
                                .place = {.file = path},
                                .key = key,
                                .expected = expected});
  }
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    throw ConfigError(Complaint{.what = "a value of the ROS map file cannot be read",
                                .place = placeOf(path, node),
                                .key = key,
                                .got = node.IsScalar() ? node.Scalar() : "no single value",
                                .expected = expected});
  }
}

void expectThat(bool holds, const std::string& path, const YAML::Node& root, const char* key,
                const char* expected) {
  if (holds) return;
  const YAML::Node node = root[key];
  throw ConfigError(Complaint{.what = "a value of the ROS map file is out of range",
                              .place = placeOf(path, node),
                              .key = key,
                              .got = node.IsScalar() ? node.Scalar() : "a list",
                              .expected = expected});
}

YAML::Node parsed(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw DataError(Complaint{.what = "there is no such file",
                              .place = {.file = path},
                              .suggestion = "check the path and its spelling"});
  }
  try {
    YAML::Node root = YAML::LoadFile(path);
    if (root.IsMap()) return root;
  } catch (const YAML::Exception& error) {
    throw ConfigError(
        Complaint{.what = "the ROS map file is no YAML: " + error.msg,
                  .place = {.file = path, .line = error.mark.line + 1, .column = error.mark.column + 1}});
  }
  throw ConfigError(Complaint{.what = "the ROS map file holds no keys", .place = {.file = path}});
}

RosHeader headerIn(const std::string& path) {
  const YAML::Node root = parsed(path);
  const std::set<std::string> known{"image", "resolution",      "origin",     "negate",
                                    "mode",  "occupied_thresh", "free_thresh"};
  for (const auto& entry : root) {
    const auto key = entry.first.as<std::string>();
    if (known.contains(key)) continue;
    throw ConfigError(
        Complaint{.what = "this key is not known in a ROS map file",
                  .place = placeOf(path, entry.first),
                  .key = key,
                  .expected = "image, resolution, origin, negate, mode, occupied_thresh, free_thresh"});
  }
  RosHeader header;
  header.image = valueOf<std::string>(path, root, "image", "the image's file name");
  header.resolution = valueOf<double>(path, root, "resolution", "metres per pixel");
  expectThat(std::isfinite(header.resolution) && header.resolution > 0.0, path, root, "resolution",
             "a positive number of metres per pixel");
  const auto origin = valueOf<std::vector<double>>(path, root, "origin", "[x_m, y_m, yaw_rad]");
  expectThat(origin.size() == 3, path, root, "origin", "[x_m, y_m, yaw_rad]");
  for (const double value : origin) expectThat(std::isfinite(value), path, root, "origin", "finite numbers");
  header.origin = {origin[0], origin[1], origin[2]};
  header.negate = valueOf<int>(path, root, "negate", "0 or 1") != 0;
  header.occupied_thresh = valueOf<double>(path, root, "occupied_thresh", "0 to 1");
  header.free_thresh = valueOf<double>(path, root, "free_thresh", "0 to 1");
  expectThat(header.free_thresh >= 0.0 && header.free_thresh < header.occupied_thresh, path, root,
             "free_thresh", "0 up to less than occupied_thresh");
  expectThat(header.occupied_thresh <= 1.0, path, root, "occupied_thresh", "0 to 1");
  if (root["mode"]) {
    const auto mode = valueOf<std::string>(path, root, "mode", "trinary or scale");
    expectThat(mode == "trinary" || mode == "scale", path, root, "mode", "trinary or scale");
    header.scale = mode == "scale";
  }
  return header;
}

cv::Mat imageOf(const std::string& yaml_path, const RosHeader& header) {
  const std::filesystem::path image_path = std::filesystem::path(yaml_path).parent_path() / header.image;
  cv::Mat image;
  if (std::filesystem::is_regular_file(image_path)) {
    image = cv::imread(image_path.string(), cv::IMREAD_GRAYSCALE);
  }
  if (!image.empty()) return image;
  throw DataError(Complaint{.what = "the image of the ROS map is missing or cannot be read",
                            .place = {.file = yaml_path},
                            .key = "image",
                            .got = image_path.string(),
                            .expected = "a PGM or PNG image beside the YAML file"});
}

/// As map_server reads a pixel: dark is occupied unless negated.
std::uint8_t percentOf(std::uint8_t pixel, const RosHeader& header) {
  const double occupied = (header.negate ? pixel : 255 - pixel) / 255.0;
  if (occupied > header.occupied_thresh) return 100;
  if (occupied < header.free_thresh) return 0;
  if (!header.scale) return OccupancyGrid::kUnknown;
  const double ratio = (occupied - header.free_thresh) / (header.occupied_thresh - header.free_thresh);
  return static_cast<std::uint8_t>(std::lround(99.0 * ratio));
}

}  // namespace

OccupancyGrid loadRosGrid(const std::string& yaml_path) {
  const RosHeader header = headerIn(yaml_path);
  const cv::Mat image = imageOf(yaml_path, header);
  OccupancyGrid grid;
  grid.T_map_grid = header.origin;
  grid.resolution = header.resolution;
  grid.columns = image.cols;
  grid.rows = image.rows;
  grid.occupancy.reserve(image.total());
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column)
      grid.occupancy.push_back(percentOf(image.at<std::uint8_t>(row, column), header));
  }
  return grid;
}

}  // namespace pos::io
