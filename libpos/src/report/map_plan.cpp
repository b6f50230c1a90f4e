#include "pos/report/map_plan.hpp"

#include "plan_parts.hpp"
#include "pos/report/png.hpp"

namespace pos::report {
namespace {

/// The cells of a map without roadways; beside roadways they would say the same twice.
void drawGrid(plan::Sheet& sheet) {
  if (!sheet.map.grid || !sheet.map.roadways.empty()) return;
  const map::OccupancyGrid& grid = *sheet.map.grid;
  const GridPicture drawn = gridPicture(grid, 2000);
  const double y_top = grid.y_min + grid.resolution * grid.rows;
  const double step = grid.resolution * drawn.step;
  const auto at = [&](double x, double y) {
    return sheet.pixel(grid.T_map_grid * Eigen::Vector2d(grid.x_min + x, y_top - y));
  };
  const Pixel origin = at(0.0, 0.0);
  const Pixel u = at(step, 0.0);
  const Pixel v = at(0.0, step);
  sheet.drawing.add(DrawnImage{.bytes = pngBytes(drawn.picture),
                               .columns = drawn.picture.columns,
                               .rows = drawn.picture.rows,
                               .origin = origin,
                               .along_u = {u.x - origin.x, u.y - origin.y},
                               .along_v = {v.x - origin.x, v.y - origin.y},
                               .clip = sheet.frame});
}

void drawBackground(plan::Sheet& sheet) {
  if (!sheet.options.background) return;
  const PlanBackground& picture = *sheet.options.background;
  const auto at = [&](double column, double row) {
    return sheet.pixel(picture.T_map_pixel * Eigen::Vector3d(column, row, 1.0));
  };
  const Pixel origin = at(0.0, 0.0);
  const Pixel u = at(1.0, 0.0);
  const Pixel v = at(0.0, 1.0);
  sheet.drawing.add(DrawnImage{.bytes = picture.bytes,
                               .columns = picture.columns,
                               .rows = picture.rows,
                               .origin = origin,
                               .along_u = {u.x - origin.x, u.y - origin.y},
                               .along_v = {v.x - origin.x, v.y - origin.y},
                               .clip = sheet.frame});
}

}  // namespace

MapPlan mapPlan(const map::TunnelMap& map, const PlanOptions& options) {
  plan::Sheet sheet(map, options);
  drawBackground(sheet);
  drawGrid(sheet);
  plan::drawFrame(sheet);
  plan::drawRoadways(sheet);
  plan::drawIntervals(sheet);
  plan::drawCrossings(sheet);
  plan::drawFurniture(sheet);
  plan::drawChainage(sheet);
  sheet.placeLabels();
  plan::drawMargins(sheet);
  return {std::move(sheet.drawing), sheet.metres_per_pixel, sheet.labels_left_out, sheet.widened};
}

}  // namespace pos::report
