#pragma once
/// Simulated ultra-wide-band ranging between tags on the vehicle and anchors of the map.

#include <memory>
#include <vector>

#include "pos/map/tunnel_map.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/radio_errors.hpp"
#include "pos/sim/rock_plan.hpp"
#include "pos/sim/timing.hpp"
#include "pos/sim/two_way_ranging.hpp"

namespace pos::sim {

/// A tag on the vehicle.
struct Tag {
  TagId id = 0;
  Eigen::Vector3d tag_body = Eigen::Vector3d::Zero();  ///< m, FLU
  double delay = 0.0;                                  ///< s after the cycle's tick
  std::string mount = {};  ///< name of its place on the vehicle, which a scenario puts into tag_body
};

/// TwoWay: six stamps of two clocks (two_way_ranging.hpp), the range computed from the counts.
/// Gaussian: true range + sigma * normal.
/// TagNoise: sigma * normal on each of the tag's x and y (and sigma_z on z) once a cycle, delivered as ranges
/// from the displaced tag to all anchors. This is the paper's simulator: solving such ranges gives back its
/// noisy tag coordinates exactly.
/// TagPosition: the same displaced tag, delivered as a PassageFix "tag <id>" (covariance sigma^2), one a tag
/// and cycle; anchors, schedule and radio errors play no part.
enum class RangeMode { TwoWay, Gaussian, TagNoise, TagPosition };

/// Simultaneous: all links of a cycle at its tick. Sequential: one link a slot, tag after tag, anchor after
/// anchor in the order of the map.
struct RangeSchedule {
  enum class Kind { Simultaneous, Sequential } kind = Kind::Simultaneous;
  double slot = 3e-3;  ///< s
};

/// Spread of the devices in TwoWay mode, drawn once a run and device.
struct RadioDevices {
  double rate_error_max = 20e-6;     ///< -, clock rates uniform within +- this
  double antenna_delay = 128.8e-9;   ///< s, each way, as calibrated
  double antenna_delay_sigma = 0.0;  ///< s, what calibration left over
};

struct UwbConfig {
  std::string sensor = "uwb";
  Timing timing = {};  ///< rate of whole cycles
  std::vector<Tag> tags = {};
  RangeSchedule schedule = {};
  RangeMode mode = RangeMode::Gaussian;
  /// m, 1 sigma. Gaussian: of a range. TagNoise, TagPosition: of each axis of the tag. TwoWay: of what is
  /// added to the range; 0 when the receive jitter is to be the only noise.
  double sigma = 0.10;
  double sigma_z = 0.0;               ///< m, TagNoise and TagPosition
  std::vector<RangeZone> zones = {};  ///< the first that contains the vehicle replaces sigma
  TwoWayConfig two_way = {};
  RadioDevices devices = {};
  RadioErrors errors = {};
  double range_max = 100.0;              ///< m, true distance
  double survey_error = 0.0;             ///< anchors truly stand survey_error * survey_sigma * normal beside
                                         ///< their place in the map, per axis; 0 or 1 as a rule
  std::optional<RadioPower> power = {};  ///< absent: no powers reported
  std::optional<double> claimed_sigma = {};  ///< m, reported with every range; absent: none reported
  bool report_tag_body = true;               ///< ranges tell where their tag sits
};

/// Throws ConfigError naming the first thing wrong (no tags, two tags of one id, a cycle of slots longer than
/// the period, ...).
UwbConfig validated(UwbConfig config);

/// Each range carries the moment it was measured (mid-exchange). A range that would come out at zero or below
/// is not delivered. The anchors' `range_bias` is part of the truth: it is added here, as estimators subtract
/// it. Constant memory: one small state a link.
class UwbStream : public SensorStream {
 public:
  /// An empty line of sight sees everything.
  UwbStream(const UwbConfig& config, const std::vector<map::Anchor>& anchors,
            std::shared_ptr<const Motion> motion, const RunSetup& run, LineOfSight line_of_sight = {});
  ~UwbStream() override;

  std::optional<Delivery> next() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One exchange of a bench: a true distance and what the radios made of it.
struct BenchExchange {
  double distance = 0.0;      ///< m
  double rate_error_a = 0.0;  ///< -
  double rate_error_b = 0.0;  ///< -
  TwoWayConfig config = {};
  TwoWayStamps stamps = {};
  double range = 0.0;  ///< m, from the counts
};

/// Spec A 3.5, A3: every pair of reply times of {0.3, 1, 3} ms, clock errors of {-20, 0, +20} ppm for either
/// radio, `distances` in m; without antenna delay; `jitter` s on the receive stamps.
std::vector<BenchExchange> twoWayBench(const std::vector<double>& distances, double jitter,
                                       std::uint64_t seed);

}  // namespace pos::sim
