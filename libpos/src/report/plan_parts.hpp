#pragma once
/// What the parts of a map's plan share. Internal to report.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pos/map/outline.hpp"
#include "pos/report/map_plan.hpp"

namespace pos::report::plan {

inline constexpr double kNarrowest = 3.0;  ///< px, roadways are drawn at least this wide

/// Where there is room for a label. Roadways are soft: a label avoids them if it can.
class Room {
 public:
  Room(double width, double height);

  enum class Mark : std::uint8_t { Free = 0, Soft = 1, Hard = 2 };
  void mark(const Box& box, Mark with);
  /// Marks a band around a line.
  void markLine(const std::vector<Pixel>& line, double width, Mark with);
  /// Whether the box is inside the limits and meets nothing harder than `tolerated`.
  bool fits(const Box& box, Mark tolerated) const;
  void limitTo(const Box& box) { limits_ = box; }

 private:
  static constexpr double kCell = 3.0;  // px
  int columns_;
  int rows_;
  std::vector<std::uint8_t> cells_;
  Box limits_;
};

struct Label {
  Pixel at = {};          ///< of what it names
  Pixel outward = {};     ///< unit vector to where the label should stand
  double distance = 6.0;  ///< px between `at` and the text
  std::string text = {};
  double size = 11.0;
  Colour colour = "#1c2530";
  bool bold = false;
  bool inside = false;  ///< may stand on `at` itself when that has room
};

/// The map, its scale on the sheet, and the drawing under way.
class Sheet {
 public:
  Sheet(const map::TunnelMap& map, const PlanOptions& options);

  const map::TunnelMap& map;
  const PlanOptions& options;
  std::vector<map::Centreline> centrelines;  ///< of all roadways
  std::vector<bool> shown;                   ///< roadways of the chosen level
  Drawing drawing;
  Box frame;  ///< of the plan, px
  double metres_per_pixel = 1.0;
  std::size_t labels_left_out = 0;
  std::size_t chambers_drawn = 0;
  std::size_t anchors_drawn = 0;
  bool widened = false;

  Pixel pixel(const Eigen::Vector2d& p_map) const;
  Eigen::Vector2d mapPoint(const Pixel& p) const;
  std::vector<Pixel> pixels(const map::PlanLine& line) const;
  /// Letters and signs in the margins grow with the sheet, so that a large one can be read from afar.
  double marginScale() const { return marginScale(frame.width); }
  static double marginScale(double frame_width);
  double tolerance() const { return 0.2 * metres_per_pixel; }  ///< m, of curves drawn as lines
  /// Half the width a roadway is drawn with, m.
  double halfWidth(map::RoadwayIndex roadway) const;
  /// Index of the roadway; nothing when it is not shown.
  std::optional<map::RoadwayIndex> shownIndex(const std::string& roadway) const;
  /// Pixel and unit vectors (px axes) along and to the left of the roadway there.
  struct Spot {
    Pixel at;
    Pixel along;
    Pixel left;
  };
  Spot spot(map::RoadwayIndex roadway, double chainage, double offset = 0.0) const;

  Room& room() { return room_; }
  /// Labels wait until everything is drawn; the first asked for have the best chances.
  void label(Label label) { labels_.push_back(std::move(label)); }
  void placeLabels();

 private:
  bool place(const Label& label, Room::Mark tolerated);

  double scale_x_ = 0.0;  ///< m, map x of the frame's left edge
  double scale_y_ = 0.0;  ///< m, map y of the frame's upper edge
  Room room_{1.0, 1.0};
  std::vector<Label> labels_;
};

void drawRoadways(Sheet& sheet);
void drawIntervals(Sheet& sheet);
void drawCrossings(Sheet& sheet);
void drawFurniture(Sheet& sheet);
void drawChainage(Sheet& sheet);
void drawFrame(Sheet& sheet);
/// Title above, legend, north arrow and scale bar below.
void drawMargins(Sheet& sheet);
/// Height of what drawMargins puts above and below the frame, px.
double titleHeight(double width);
double legendHeight(const map::TunnelMap& map, const PlanOptions& options, double width);

/// Around the drawing's own origin; `width` in px before the margins are enlarged.
void drawLegend(Drawing& drawing, const Sheet& sheet, double width, double top);

/// Strips of intervals on one stretch of a roadway; `from` and `to` cut them off.
void drawIntervalStrips(Sheet& sheet, map::RoadwayIndex roadway, double from, double to);
Colour intervalColour(std::size_t interval);

}  // namespace pos::report::plan
