#pragma once
/// A scenario: one experiment as data. What moves how, in which vehicle, on which Earth and map, and with
/// which sensors. `Simulation` (simulation.hpp) makes it run, io/scenario_yaml.hpp reads it.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pos/sim/earth.hpp"
#include "pos/sim/encoder.hpp"
#include "pos/sim/gnss_stream.hpp"
#include "pos/sim/imu.hpp"
#include "pos/sim/leg_stream.hpp"
#include "pos/sim/lidar_stream.hpp"
#include "pos/sim/motion_plan.hpp"
#include "pos/sim/passage_stream.hpp"
#include "pos/sim/rock_plan.hpp"
#include "pos/sim/uwb_stream.hpp"
#include "pos/sim/vehicle.hpp"

namespace pos::sim {

/// A laser scanner among the legs of the supports that a shearer leaves behind. Needs a shearer's motion.
struct SupportLegSensor {
  LegConfig config = {};
  double lateral = 4.0;  ///< m, legs stand this far to the left of the conveyor's line (away from the coal)
};

using SensorModel =
    std::variant<ImuModel, EncoderModel, UwbConfig, GnssConfig, LidarConfig, SupportLegSensor, PassageConfig>;

/// One sensor of a scenario.
struct SensorEntry {
  std::string name = {};   ///< label of its measurements; its random numbers hang on it
  std::string mount = {};  ///< name of its place on the vehicle; empty: the place is in the model
  SensorModel model = {};
};

/// Where the rock is, for lines of sight.
struct RockConfig {
  enum class Source {
    None,      ///< everything is in sight
    Outlines,  ///< the outlines below
    Roadways,  ///< everything beside the roadways and chambers of the map
  };
  Source source = Source::None;
  std::vector<Outline> open_spaces = {};  ///< outlines of the open spaces, their walls block
};

struct Scenario {
  int schema = 1;
  std::string name = {};
  std::string source = {};                        ///< where it was published: authors, year, section
  std::string inferred = {};                      ///< what the publication does not say and we chose
  std::optional<std::filesystem::path> map = {};  ///< absolute after loading; absent: no anchors
  /// Only while a file is read: the vehicle's own file, over which `vehicle` of the scenario was laid.
  std::optional<std::filesystem::path> vehicle_file = {};
  Vehicle vehicle = {};
  /// The origin of Level and Ellipsoid is the map's.
  EarthConfig earth = {};
  MotionConfig motion = {};
  std::optional<double> duration = {};  ///< s, of the sensors; absent: as long as the motion
  double start = 1704067200.0;          ///< s since 1970-01-01 UTC, the stamp of t = 0
  RockConfig rock = {};
  std::vector<SensorEntry> sensors = {};  ///< names are unique
};

/// The scenario itself when it can be run on some map: names, mounts, what each motion, vehicle and sensor
/// says. Throws ConfigError with the key as in the file.
Scenario validated(Scenario scenario);

}  // namespace pos::sim
