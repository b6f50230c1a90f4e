#include "pos/io/map_raster.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/map/outline.hpp"

namespace pos::io {
namespace {

using map::OccupancyGrid;
using map::PlanLine;

constexpr double kMostCells = 2e8;

std::string joinedLevels(const std::set<std::string>& levels) {
  return text::joined({levels.begin(), levels.end()});
}

std::vector<PlanLine> openSpaces(const map::TunnelMap& map, const RasterRules& rules) {
  const double tolerance = 0.1 * rules.resolution;
  std::vector<PlanLine> spaces;
  std::set<std::string> levels;
  for (const map::Roadway& roadway : map.roadways) {
    levels.insert(roadway.level);
    if (!rules.level.empty() && roadway.level != rules.level) continue;
    const map::Centreline line(roadway);
    const double half = 0.5 * roadway.width;
    spaces.push_back(map::strip(line, line.chainageStart(), line.chainageEnd(), half, -half, tolerance));
    for (const map::Chamber& chamber : map.chambers) {
      if (chamber.place.roadway == roadway.id && chamber.length > 0.0)
        spaces.push_back(map::chamberOutline(roadway, line, chamber, tolerance, rules.resolution));
    }
  }
  if (spaces.empty()) {
    throw ConfigError(Complaint{.what = "there are no roadways to make a grid of",
                                .key = rules.level.empty() ? "roadways" : "level",
                                .got = rules.level,
                                .expected = rules.level.empty() ? "" : "one of: " + joinedLevels(levels)});
  }
  return spaces;
}

/// An empty grid that holds the spaces with their margin.
OccupancyGrid frameAround(const std::vector<PlanLine>& spaces, const RasterRules& rules) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = -low;
  for (const PlanLine& space : spaces) {
    for (const Eigen::Vector2d& p : space) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const Eigen::Vector2d first = ((low.array() - rules.margin) / rules.resolution).floor();
  const Eigen::Vector2d last = ((high.array() + rules.margin) / rules.resolution).ceil();
  const Eigen::Vector2d size = last - first;
  if (!(size.prod() <= kMostCells)) {
    const double enough = rules.resolution * std::sqrt(size.prod() / kMostCells);
    throw ConfigError(Complaint{.what = "the grid would have too many cells",
                                .key = "resolution",
                                .got = text::fixed(size.x(), 0) + " x " + text::fixed(size.y(), 0) + " cells",
                                .expected = "at most 2e8",
                                .suggestion = "use cells of " +
                                              text::fixed(std::ceil(20.0 * enough) / 20.0, 2) +
                                              " m or more, or one level at a time"});
  }
  OccupancyGrid grid;
  grid.x_min = first.x() * rules.resolution;
  grid.y_min = first.y() * rules.resolution;
  grid.resolution = rules.resolution;
  grid.columns = static_cast<int>(size.x());
  grid.rows = static_cast<int>(size.y());
  return grid;
}

/// Where an edge crosses the line through the middles of a row of cells, and which way it goes.
struct Crossing {
  double column = 0.0;  ///< cells
  int direction = 0;
};

std::vector<std::vector<Crossing>> crossingsOf(const PlanLine& polygon, const OccupancyGrid& grid) {
  std::vector<std::vector<Crossing>> rows(static_cast<std::size_t>(grid.rows));
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d min(grid.x_min, grid.y_min);
    Eigen::Vector2d a = (polygon[i] - min) / grid.resolution;
    Eigen::Vector2d b = (polygon[(i + 1) % polygon.size()] - min) / grid.resolution;
    const int direction = a.y() < b.y() ? 1 : -1;
    if (direction < 0) std::swap(a, b);
    const int first = std::max(0, static_cast<int>(std::ceil(a.y() - 0.5)));
    const int past = std::min(grid.rows, static_cast<int>(std::ceil(b.y() - 0.5)));
    for (int row = first; row < past; ++row) {
      const double f = (row + 0.5 - a.y()) / (b.y() - a.y());
      rows[static_cast<std::size_t>(row)].push_back({a.x() + f * (b.x() - a.x()), direction});
    }
  }
  return rows;
}

/// Frees the cells whose middle the polygon winds around (OpenCV's fillPoly also takes those its edge
/// touches, which makes every roadway a cell wider; and a strip that overlaps itself in a tight bend has no
/// hole here).
void freeInside(OccupancyGrid& grid, const PlanLine& polygon) {
  auto rows = crossingsOf(polygon, grid);
  for (int row = 0; row < grid.rows; ++row) {
    auto& crossings = rows[static_cast<std::size_t>(row)];
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.column < b.column; });
    std::uint8_t* const cells =
        grid.occupancy.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns);
    int winding = 0;
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
      winding += crossings[k].direction;
      if (winding == 0) continue;
      const int first = std::clamp(static_cast<int>(std::ceil(crossings[k].column - 0.5)), 0, grid.columns);
      const int past =
          std::clamp(static_cast<int>(std::ceil(crossings[k + 1].column - 0.5)), first, grid.columns);
      std::fill(cells + first, cells + past, std::uint8_t{0});
    }
  }
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return;
  throw DataError(Complaint{.what = "the file cannot be written",
                            .place = {.file = path.string()},
                            .suggestion = "check that the folder exists and the disk is not full"});
}

char pixelOf(std::uint8_t percent) {
  if (percent == OccupancyGrid::kUnknown) return static_cast<char>(205);
  if (percent > 65) return 0;
  return static_cast<char>(percent < 19 ? 254 : 205);
}

}  // namespace

RasterRules validated(RasterRules rules) {
  const auto refuse = [](const char* key, double got, const char* expected) {
    throw ConfigError(Complaint{
        .what = "the grid cannot be made so", .key = key, .got = text::shortest(got), .expected = expected});
  };
  if (!(rules.resolution >= 0.01 && rules.resolution <= 10.0))
    refuse("resolution", rules.resolution, "0.01 to 10 m");
  if (!(rules.margin >= 0.0 && rules.margin <= 1000.0)) refuse("margin", rules.margin, "0 to 1000 m");
  return rules;
}

OccupancyGrid rasterised(const map::TunnelMap& map, const RasterRules& wanted) {
  const RasterRules rules = validated(wanted);
  const auto spaces = openSpaces(map, rules);
  OccupancyGrid grid = frameAround(spaces, rules);
  grid.occupancy.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), 100);
  for (const PlanLine& space : spaces) freeInside(grid, space);
  return grid;
}

void saveRosGrid(const OccupancyGrid& grid, const std::string& yaml_path) {
  const std::filesystem::path yaml = yaml_path;
  std::filesystem::path image = yaml;
  image.replace_extension(".pgm");
  std::string pixels = "P5\n" + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n";
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column) pixels += pixelOf(grid.at(column, row));
  }
  writeText(image, pixels);
  const Eigen::Vector2d corner = grid.T_map_grid * Eigen::Vector2d(grid.x_min, grid.y_min);
  writeText(yaml, "image: " + image.filename().string() + "\nmode: trinary\nresolution: " +
                      text::shortest(grid.resolution) + "\norigin: [" + text::shortest(corner.x()) + ", " +
                      text::shortest(corner.y()) + ", " + text::shortest(grid.T_map_grid.yaw) +
                      "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

}  // namespace pos::io
