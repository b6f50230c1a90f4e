/// `pos map export` and `render`: maps for other programs, and on paper.

#include <algorithm>
#include <memory>

#include "pos/core/error.hpp"
#include "pos/io/background.hpp"
#include "pos/io/beacon_map_io.hpp"
#include "pos/io/dxf_map.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_geojson.hpp"
#include "pos/io/map_raster.hpp"
#include "pos/io/text.hpp"
#include "pos/report/map_plan.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct PlanFiles {
  std::string map;
  std::string out;
  report::PlanOptions plan;
  bool no_intervals = false;
  bool no_background = false;
  int merge = 1;
};

/// The scanned plan, with the misfit of its control points on standard error.
std::optional<report::PlanBackground> backgroundOf(const map::TunnelMap& map, const fs::path& map_file,
                                                   const Voice& voice) {
  if (!map.background) return std::nullopt;
  const io::AffineFit fit = io::affineFit(map.background->control_points);
  voice.say("background: " + io::text::fixed(fit.metres_per_pixel, 3) + " m a pixel, misfit of the " +
            std::to_string(fit.residuals.size()) + " control points " +
            (fit.residuals.size() > 3 ? io::text::fixed(fit.rms, 2) + " m rms"
                                      : std::string("unknown: a fourth point would tell")));
  for (std::size_t i = 0; i < fit.residuals.size(); ++i) {
    voice.detail("  control point " + std::to_string(i + 1) + ": " + io::text::fixed(fit.residuals[i], 3) +
                 " m");
  }
  io::BackgroundPicture picture = io::loadPicture(map_file.parent_path() / map.background->file);
  return report::PlanBackground{std::move(picture.bytes), picture.columns, picture.rows, fit.T_map_pixel};
}

/// The lock intervals with a stretch on a roadway that is locked; where no lock is needed they only confuse.
std::vector<map::LockInterval> lockedIntervals(const map::Network& network, int merge) {
  const auto& roadways = network.map().roadways;
  auto intervals = map::divided(map::RoadGraph(network), network, {.merge = merge});
  std::erase_if(intervals, [&](const map::LockInterval& interval) {
    return std::none_of(interval.spans.begin(), interval.spans.end(),
                        [&](const map::IntervalSpan& span) { return roadways[span.roadway].locked; });
  });
  return intervals;
}

report::MapPlan planOf(const PlanFiles& files, const Voice& voice) {
  const map::TunnelMap map = mapOf(files.map);
  report::PlanOptions options = files.plan;
  if (!files.no_background) options.background = backgroundOf(map, files.map, voice);
  if (!files.no_intervals && !map.roadways.empty()) {
    const map::Network network(std::make_shared<const map::TunnelMap>(map));
    options.intervals = lockedIntervals(network, files.merge);
  }
  report::MapPlan plan = report::mapPlan(map, options);
  voice.say(files.out + ": " + io::text::fixed(plan.drawing.width, 0) + " x " +
            io::text::fixed(plan.drawing.height, 0) + " px, " + io::text::fixed(plan.metres_per_pixel, 3) +
            " m a pixel" +
            (plan.labels_left_out > 0 ? ", " + std::to_string(plan.labels_left_out) +
                                            " labels left out for lack of room (try a larger --width-px)"
                                      : ""));
  return plan;
}

void runRender(const PlanFiles& files, const Voice& voice) {
  const bool png = files.out.ends_with(".png");
  if (!png && !files.out.ends_with(".svg")) {
    throw UsageError(Complaint{.what = "the ending does not tell what to draw",
                               .key = "--out",
                               .got = files.out,
                               .expected = "*.svg or *.png"});
  }
  const report::MapPlan plan = planOf(files, voice);
  writeFile(files.out, png ? report::drawingPng(plan.drawing) : report::drawingSvg(plan.drawing));
}

struct ExportFiles {
  PlanFiles plan;
  std::string to;
  std::string frame = "map";
  io::RasterRules raster = {.resolution = 0.1};
  std::vector<const CLI::Option*> for_dxf;
  std::vector<const CLI::Option*> for_grids;
  std::vector<const CLI::Option*> for_plans;
  std::vector<const CLI::Option*> for_grids_and_plans;
};

std::string formatOf(const ExportFiles& files) {
  if (!files.to.empty()) return files.to;
  const std::string& out = files.plan.out;
  for (const auto& [ending, format] :
       std::initializer_list<std::pair<const char*, const char*>>{{".geojson", "geojson"},
                                                                  {".json", "geojson"},
                                                                  {".dxf", "dxf"},
                                                                  {".svg", "svg"},
                                                                  {".png", "png"},
                                                                  {".gridmap.gz", "gridmap"},
                                                                  {".gridmap", "gridmap"},
                                                                  {".beaconmap", "beaconmap"}}) {
    if (out.ends_with(ending)) return format;
  }
  throw UsageError(
      Complaint{.what = "the ending does not tell what to write",
                .key = "--out",
                .got = out,
                .expected = "*.geojson, *.dxf, *.svg, *.png, *.gridmap.gz, *.beaconmap; or --to ros"});
}

/// The grid of the roadways; a map without roadways gives its own.
map::OccupancyGrid gridOf(const ExportFiles& files, const Voice& voice) {
  const map::TunnelMap map = mapOf(files.plan.map);
  const map::OccupancyGrid grid =
      map.roadways.empty() && map.grid ? *map.grid : io::rasterised(map, files.raster);
  voice.say(files.plan.out + ": " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
            " cells of " + io::text::shortest(grid.resolution) + " m");
  return grid;
}

/// Options that the format cannot heed are refused rather than ignored.
void requireUseful(const ExportFiles& files, const std::string& format) {
  const bool plan = format == "svg" || format == "png";
  const bool grid = format == "gridmap" || format == "ros";
  const std::string what = "an export to " + format;
  if (format != "dxf") refuseGiven(files.for_dxf, what);
  if (!grid) refuseGiven(files.for_grids, what);
  if (!plan) refuseGiven(files.for_plans, what);
  if (!plan && !grid) refuseGiven(files.for_grids_and_plans, what);
}

void runExport(const ExportFiles& files, const Voice& voice) {
  const std::string format = formatOf(files);
  requireUseful(files, format);
  const std::string& in = files.plan.map;
  const std::string& out = files.plan.out;
  if (format == "geojson")
    writeFile(out, io::mapGeoJson(io::moved(io::readMapFile(in), folderOf(in), folderOf(out))));
  if (format == "dxf")
    writeFile(out, io::mapDxf(mapOf(in), files.frame == "mine" ? io::DxfFrame::MineGrid : io::DxfFrame::Map));
  if (format == "svg") writeFile(out, report::drawingSvg(planOf(files.plan, voice).drawing));
  if (format == "png") writeFile(out, report::drawingPng(planOf(files.plan, voice).drawing));
  if (format == "gridmap") io::saveMrptGrid(gridOf(files, voice), out);
  if (format == "ros") io::saveRosGrid(gridOf(files, voice), out);
  if (format == "beaconmap") io::saveBeaconMap(mapOf(in), out);
}

std::vector<const CLI::Option*> addPlanOptions(CLI::App& verb, PlanFiles& files) {
  return {verb.add_option("--width-px", files.plan.width, "Width of the sheet (default: as the map needs)"),
          verb.add_option("--merge", files.merge,
                          "Every how many-th chamber is a boundary of lock intervals (default 1)")
              ->check(CLI::Range(1, 1000)),
          verb.add_flag("--no-intervals", files.no_intervals,
                        "Without lock intervals (they are drawn for roadways that are locked)"),
          verb.add_flag("--no-background", files.no_background, "Without the scanned plan")};
}

}  // namespace

void addMapExport(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("export", "A map as GeoJSON, DXF, SVG, PNG, MRPT or ROS files");
  auto files = std::make_shared<ExportFiles>();
  verb->add_option("map", files->plan.map, "Map file")->required();
  verb->add_option("--out", files->plan.out,
                   "*.geojson, *.dxf, *.svg, *.png, *.gridmap.gz, *.beaconmap; with --to ros *.yaml")
      ->required();
  verb->add_option("--to", files->to, "Format, where the ending does not tell it")
      ->check(CLI::IsMember({"geojson", "dxf", "svg", "png", "gridmap", "beaconmap", "ros"}));
  files->for_dxf = {verb->add_option("--frame", files->frame,
                                     "DXF: coordinates of the map or of the mine's grid (default map)")
                        ->check(CLI::IsMember({"map", "mine"}))};
  files->for_grids = {
      verb->add_option("--resolution-m", files->raster.resolution, "Grids: size of a cell (default 0.1)"),
      verb->add_option("--margin-m", files->raster.margin, "Grids: rock around the roadways (default 2)")};
  files->for_grids_and_plans = {
      verb->add_option("--level", files->raster.level, "Grids and plans: only roadways of this level")};
  files->for_plans = addPlanOptions(*verb, files->plan);
  addVoice(*verb, *verbs.voice);
  verb->callback([files, verbs] {
    files->plan.plan.level = files->raster.level;
    runExport(*files, *verbs.voice);
  });
}

void addMapRender(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("render", "Draw a plan of the map (*.svg or *.png)");
  auto files = std::make_shared<PlanFiles>();
  verb->add_option("map", files->map, "Map file")->required();
  verb->add_option("--out", files->out, "Picture to write, *.svg or *.png")->required();
  verb->add_option("--level", files->plan.level, "Only roadways of this level");
  addPlanOptions(*verb, *files);
  addVoice(*verb, *verbs.voice);
  verb->callback([files, verbs] { runRender(*files, *verbs.voice); });
}

}  // namespace pos::app
