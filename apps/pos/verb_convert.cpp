/// `pos convert`: from other people's files into ours, and out again.

#include <memory>

#include "common.hpp"
#include "convert_log.hpp"
#include "pos/core/error.hpp"
#include "pos/io/beacon_map_io.hpp"
#include "pos/io/csv_import.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/rawlog_writer.hpp"
#include "pos/io/run_geojson.hpp"
#include "pos/io/run_mcap.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct CsvOptions {
  std::string mapping;
  std::string data;
  std::string out;
  io::ImportOptions import;
};

void sayCounts(const io::ImportResult& result, const Voice& voice) {
  for (const io::TableCount& table : result.counts.tables) {
    voice.say(table.file + ": " + std::to_string(table.rows) + " rows of " + table.kind +
              (table.skipped > 0
                   ? ", " + std::to_string(table.skipped) + " left out (" + table.first_skipped + ")"
                   : ""));
  }
  if (result.counts.outliers_injected > 0) {
    voice.say("outliers put in on purpose: " + std::to_string(result.counts.outliers_injected));
  }
  if (result.counts.ranges_to_unknown_anchors > 0) {
    voice.warn(std::to_string(result.counts.ranges_to_unknown_anchors) +
               " ranges are to anchors that the map does not have");
  }
}

ExitCode convertCsv(const CsvOptions& options, const Voice& voice) {
  const io::ImportResult result = io::importCsv(options.mapping, options.data, options.import);
  const fs::path folder = options.out;
  fs::create_directories(folder);
  io::RawlogWriter log((folder / "log.rawlog").string());
  for (const Measurement& measurement : result.measurements) log.write(measurement);
  log.close();
  io::saveMap(result.map, folder / "map.yaml");
  if (result.truth) io::writeTum(folder / "truth.tum", *result.truth);
  sayCounts(result, voice);
  voice.say("written: " + (folder / "log.rawlog").string() + ", map.yaml" +
            (result.truth ? ", truth.tum" : ""));
  return ExitCode::Ok;
}

ExitCode convertTrajectory(const std::string& in, const std::string& out, const std::string& to) {
  const auto estimates = fs::path(in).extension() == ".csv" ? io::readEstimateCsv(in) : io::readTum(in);
  const auto writeAll = [&](auto writer) {
    for (const Estimate& estimate : estimates) {
      if constexpr (requires { writer.write(estimate, io::EpochVerdicts{}); }) {
        writer.write(estimate, io::EpochVerdicts{});
      } else {
        writer.write(estimate);
      }
    }
    writer.close();
  };
  if (to == "tum") writeAll(io::TumWriter(out));
  if (to == "tum_covariance") writeAll(io::TumCovarianceWriter(out));
  if (to == "csv") writeAll(io::EstimateCsvWriter(out));
  return ExitCode::Ok;
}

ExitCode convertMap(const std::string& in, const std::string& out) {
  const map::TunnelMap map =
      io::loadMap(in, mrptShare(), [](const fs::path& file) { return io::loadGrid(file.string()); });
  if (out.ends_with(".beaconmap")) {
    io::saveBeaconMap(map, out);
  } else if (!out.ends_with(".gridmap.gz") && !out.ends_with(".gridmap")) {
    throw UsageError(Complaint{.what = "the ending does not tell what to write",
                               .key = "--out",
                               .got = out,
                               .expected = "*.beaconmap for the anchors, *.gridmap.gz for the grid"});
  } else if (map.grid) {
    io::saveMrptGrid(*map.grid, out);
  } else {
    throw ConfigError(Complaint{.what = "the map has no grid to write",
                                .place = {.file = in},
                                .suggestion = "write its anchors to a .beaconmap"});
  }
  return ExitCode::Ok;
}

struct RunOptions {
  std::string folder;
  std::string out;
  std::string truth;
  std::string map;
  bool wgs84 = false;
};

/// As GeoJSON, where the file is named so.
ExitCode convertTracks(const RunOptions& options, io::RunExtras extras, const Voice& voice) {
  io::TrackOptions tracks{.truth = std::move(extras.truth)};
  if (options.wgs84) {
    tracks.origin = extras.map ? extras.map->origin : std::nullopt;
    if (!tracks.origin) {
      throw UsageError(Complaint{.what = "the map's place on the Earth is not known",
                                 .key = "--wgs84",
                                 .suggestion = "name a map that has an origin with --map"});
    }
  }
  const std::uint64_t count = io::writeRunGeoJson(options.folder, options.out, tracks);
  voice.say(std::to_string(count) + " points written to " + options.out);
  return ExitCode::Ok;
}

ExitCode convertRun(const RunOptions& options, const Voice& voice) {
  io::RunExtras extras;
  if (!options.truth.empty()) extras.truth = io::readTumTruth(options.truth);
  if (!options.map.empty()) {
    extras.map = io::loadMap(options.map, mrptShare(),
                             [](const fs::path& file) { return io::loadGrid(file.string()); });
  }
  if (options.out.ends_with(".geojson")) return convertTracks(options, std::move(extras), voice);
  if (options.wgs84) {
    throw UsageError(
        Complaint{.what = "only tracks as GeoJSON can be in degrees", .key = "--wgs84", .got = options.out});
  }
  const std::uint64_t count = io::writeRunMcap(options.folder, options.out, extras);
  voice.say(std::to_string(count) + " messages written to " + options.out);
  return ExitCode::Ok;
}

void addRun(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand(
      "run", "A run folder into an MCAP file for viewers of ROS 2, or its tracks into GeoJSON");
  auto options = std::make_shared<RunOptions>();
  verb->add_option("folder", options->folder, "Folder that pos replay --out wrote")->required();
  verb->add_option("--out", options->out, "File to write: *.geojson for the tracks alone, else MCAP")
      ->required();
  verb->add_option("--truth", options->truth, "Reference poses (TUM), as /ground_truth/pose");
  verb->add_option("--map", options->map, "Map, as /map/markers and as an attachment; for --wgs84");
  verb->add_flag("--wgs84", options->wgs84, "GeoJSON in degrees, by the map's place on the Earth");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = convertRun(*options, *verbs.voice); });
}

void addCsv(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb =
      parent.add_subcommand("csv", "A folder of CSV tables into log.rawlog, map.yaml and truth.tum");
  auto options = std::make_shared<CsvOptions>();
  verb->add_option("mapping", options->mapping, "Mapping file: which column is what, in which unit")
      ->required();
  verb->add_option("--data", options->data, "Folder with the tables")->required();
  verb->add_option("--out", options->out, "Folder to write to")->required();
  options->import.range_outlier_min_m = 3.0;
  options->import.range_outlier_max_m = 20.0;
  verb->add_option("--range-outliers", options->import.range_outlier_probability,
                   "Share of ranges to spoil on purpose, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--outlier-min-m", options->import.range_outlier_min_m,
                   "Smallest error put in (default 3)");
  verb->add_option("--outlier-max-m", options->import.range_outlier_max_m,
                   "Largest error put in (default 20)");
  verb->add_option("--seed", options->import.seed, "Seed of the errors");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = convertCsv(*options, *verbs.voice); });
}

struct InOut {
  std::string in;
  std::string out;
  std::string to = "tum";
};

std::shared_ptr<InOut> addInOut(CLI::App& verb, const char* in, const char* out) {
  auto files = std::make_shared<InOut>();
  verb.add_option("in", files->in, in)->required();
  verb.add_option("--out", files->out, out)->required();
  return files;
}

}  // namespace

void addConvert(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("convert", "Convert logs, trajectories and maps");
  verb->require_subcommand(1);
  addCsv(*verb, verbs);
  addRun(*verb, verbs);
  addConvertLog(*verb, verbs);

  CLI::App* trajectory = verb->add_subcommand(
      "trajectory", "TUM, TUM with covariance, or <estimator>.csv into another of these");
  const auto trajectories = addInOut(*trajectory, "Trajectory to read", "Trajectory to write");
  trajectory->add_option("--to", trajectories->to, "Format to write")
      ->check(CLI::IsMember({"tum", "tum_covariance", "csv"}));
  trajectory->callback([trajectories, verbs] {
    *verbs.code = convertTrajectory(trajectories->in, trajectories->out, trajectories->to);
  });

  CLI::App* map =
      verb->add_subcommand("map", "map.yaml into MRPT's .beaconmap (anchors) or .gridmap.gz (grid)");
  const auto maps = addInOut(*map, "Map to read", "File to write: *.beaconmap or *.gridmap.gz");
  map->callback([maps, verbs] { *verbs.code = convertMap(maps->in, maps->out); });
}

}  // namespace pos::app
