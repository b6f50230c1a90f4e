#include "pos/report/map_plan.hpp"

#include "plan_parts.hpp"

namespace pos::report {
namespace {

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
