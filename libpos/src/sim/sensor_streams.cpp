#include "sensor_streams.hpp"

#include <type_traits>

#include "pos/core/config_checks.hpp"
#include "pos/map/network.hpp"

namespace pos::sim {
namespace {

/// A motion watched for another time than its own: sensors end with it. Beyond its end the body rests.
class TimedMotion : public Motion {
 public:
  TimedMotion(std::shared_ptr<const Motion> motion, double duration)
      : motion_(std::move(motion)), duration_(duration) {}
  Kinematics at(double t) const override { return motion_->at(t); }
  double duration() const override { return duration_; }
  double travelled(double t) const override { return motion_->travelled(t); }
  const std::vector<double>& breaks() const override { return motion_->breaks(); }

 private:
  std::shared_ptr<const Motion> motion_;
  double duration_;
};

LineOfSight lineOfSight(const RockConfig& rock, const std::shared_ptr<const map::TunnelMap>& map) {
  if (rock.source == RockConfig::Source::None) return {};
  if (rock.source == RockConfig::Source::Roadways) {
    if (map->roadways.empty())
      refuse("the map has no roadways", "rock.source", "roadways", "outlines, or none");
    return [network = map::Network(map)](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
      return network.inSight(p, q);
    };
  }
  RockPlan plan;
  for (const Outline& outline : rock.open_spaces) plan = plan.joined(RockPlan::around(outline));
  return plan.predicate();
}

EarthConfig onMap(EarthConfig earth, const map::TunnelMap& map) {
  if (earth.kind == EarthKind::Flat) return earth;
  if (!map.origin) {
    refuse("an Earth that turns needs a latitude", "earth.kind", "a map without an origin",
           "a map with an origin, or flat");
  }
  earth.origin = *map.origin;
  return earth;
}

/// Makes one stream of a model; every model is a copy that the scenario's common facts are written into.
class StreamMaker {
 public:
  StreamMaker(const SensorEntry& entry, const SensorSite& site) : entry_(entry), site_(site) {}

  std::unique_ptr<SensorStream> operator()(ImuModel model) const {
    named(model, streamOf(entry_.name));
    if (!entry_.mount.empty()) model.p_body = place(entry_.mount);
    return makeImuStream(model, site_.earth, site_.motion, site_.run);
  }

  std::unique_ptr<SensorStream> operator()(EncoderModel model) const {
    named(model, streamOf(entry_.name));
    return makeEncoderStream(model, site_.vehicle, site_.motion, site_.run);
  }

  std::unique_ptr<SensorStream> operator()(UwbConfig config) const {
    named(config, wideStreamOf(entry_.name));
    for (Tag& tag : config.tags) {
      if (!tag.mount.empty()) tag.tag_body = place(tag.mount);
    }
    if (site_.map->anchors.empty())
      refuse("there are no anchors to range to", "type", "uwb", "a map with anchors");
    return std::make_unique<UwbStream>(config, site_.map->anchors, site_.motion, site_.run,
                                       site_.line_of_sight);
  }

  std::unique_ptr<SensorStream> operator()(GnssConfig config) const {
    named(config, wideStreamOf(entry_.name));
    if (!entry_.mount.empty()) config.antenna_body = place(entry_.mount);
    if (!site_.map->origin)
      refuse("satellites need a map that is tied to the Earth", "type", "gnss", "a map with an origin");
    config.origin = *site_.map->origin;
    return std::make_unique<GnssStream>(config, site_.motion, site_.run);
  }

  std::unique_ptr<SensorStream> operator()(LidarConfig config) const {
    named(config, wideStreamOf(entry_.name));
    if (!entry_.mount.empty()) config.scanner.T_body_sensor.translation = place(entry_.mount);
    if (!site_.grid) refuse("a laser scanner needs walls to see", "type", "lidar", "a map with a grid");
    return std::make_unique<LidarStream>(config, site_.grid, site_.motion, site_.run);
  }

  std::unique_ptr<SensorStream> operator()(SupportLegSensor model) const {
    named(model.config, wideStreamOf(entry_.name));
    if (!entry_.mount.empty()) model.config.scanner.T_body_sensor.translation = place(entry_.mount);
    if (!site_.shearer) {
      refuse("support legs stand along a shearer's conveyor only", "type", "support_legs",
             "motion.type: shearer");
    }
    return std::make_unique<LegStream>(model.config, legPlacer(model), site_.motion, site_.run);
  }

  std::unique_ptr<SensorStream> operator()(PassageConfig config) const {
    named(config, wideStreamOf(entry_.name));
    if (!entry_.mount.empty()) config.antenna_body = place(entry_.mount);
    return std::make_unique<PassageStream>(config, site_.motion, site_.run);
  }

 private:
  template <class Config>
  void named(Config& config, std::uint64_t stream) const {
    config.sensor = entry_.name;
    config.timing.stream = stream;
  }

  Eigen::Vector3d place(const std::string& mount) const { return site_.vehicle.mount(mount).p_body; }

  /// Each support stands beside the line of the conveyor that it was last pulled up to.
  LegPlacer legPlacer(const SupportLegSensor& model) const {
    return [shearer = site_.shearer, row = model.config.row, lateral = model.lateral](int support, double t) {
      const double station = row.station_first + row.spacing * support;
      Eigen::Vector3d leg = shearer->pointOnLine(shearer->supportLine(station, t), station);
      leg.x() -= lateral;
      return leg;
    };
  }

  const SensorEntry& entry_;
  const SensorSite& site_;
};

void requireUniqueNames(const std::vector<SensorEntry>& sensors) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string key = indexed("sensors", i) + ".name";
    for (std::size_t j = 0; j < i; ++j) {
      if (sensors[j].name == sensors[i].name) {
        refuse("two sensors have the same name", key, sensors[i].name, "every name once");
      }
      if (wideStreamOf(sensors[j].name) == wideStreamOf(sensors[i].name)) {
        refuse("two sensors' names give the same random numbers", key, sensors[i].name, "another name",
               "rename one of the two");
      }
    }
  }
}

/// What a sensor's own configuration has wrong before any map is there.
void requireSound(const SensorEntry& entry) {
  std::visit(
      [&](auto model) {
        if constexpr (requires { model.config.sensor; }) {
          model.config.sensor = entry.name;
          (void)validated(model.config);
        } else {
          model.sensor = entry.name;
          (void)validated(model);
        }
      },
      entry.model);
}

void requireMounts(const SensorEntry& entry, const Vehicle& vehicle) {
  if (!entry.mount.empty()) (void)vehicle.mount(entry.mount);
  const auto* uwb = std::get_if<UwbConfig>(&entry.model);
  if (uwb == nullptr) return;
  for (const Tag& tag : uwb->tags) {
    if (!tag.mount.empty()) (void)vehicle.mount(tag.mount);
  }
}

}  // namespace

SensorSite sensorSite(const Scenario& scenario, std::shared_ptr<const map::TunnelMap> map,
                      std::uint64_t seed) {
  (void)validated(scenario);
  SensorSite site;
  if (const auto* config = std::get_if<ShearerConfig>(&scenario.motion)) {
    site.shearer = under("motion", [&] { return makeShearerMotion(*config); });
    site.motion = site.shearer;
  } else {
    site.motion = under("motion", [&] { return makeMotion(scenario.motion); });
  }
  site.duration = scenario.duration.value_or(site.motion->duration());
  site.motion = std::make_shared<TimedMotion>(site.motion, site.duration);
  site.earth = std::make_shared<const Earth>(onMap(scenario.earth, *map));
  if (map->grid) site.grid = {map, &*map->grid};
  site.line_of_sight = lineOfSight(scenario.rock, map);
  site.vehicle = scenario.vehicle;
  site.run = {.start = stampFromSeconds(scenario.start), .seed = seed};
  site.map = std::move(map);
  return site;
}

std::unique_ptr<SensorStream> sensorStream(const SensorEntry& entry, const std::string& key,
                                           const SensorSite& site) {
  return under(key, [&] { return std::visit(StreamMaker(entry, site), entry.model); });
}

Scenario validated(Scenario scenario) {
  requireValid(scenario.vehicle, "vehicle");
  under("motion", [&] { (void)makeMotion(scenario.motion); });
  requireUniqueNames(scenario.sensors);
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    under(indexed("sensors", i), [&] {
      requireMounts(scenario.sensors[i], scenario.vehicle);
      requireSound(scenario.sensors[i]);
    });
  }
  if (scenario.duration) requirePositive(*scenario.duration, "duration", "s");
  return scenario;
}

}  // namespace pos::sim
