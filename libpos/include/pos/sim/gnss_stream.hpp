#pragma once
/// Simulated satellite fixes, good on the surface, worse at the portal, none (or worse than none) under
/// ground.

#include <memory>
#include <vector>

#include "pos/map/geodesy.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/timing.hpp"
#include "pos/sim/zone.hpp"

namespace pos::sim {

/// How the receiver does in a stretch of the run.
struct GnssZone {
  Zone where = {};
  bool masked = false;                             ///< no fixes at all
  SigmaRamp sigma = {0.02, 0.02};                  ///< m, per horizontal axis
  double vertical_factor = 1.0;                    ///< sigma of the height / sigma of an axis
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< m, map axes
  GnssFix::Quality quality = GnssFix::Quality::RtkFixed;
};

struct GnssConfig {
  std::string sensor = "gnss";
  Timing timing = {};
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();  ///< m, FLU
  map::GeodeticOrigin origin = {};
  std::vector<GnssZone> zones = {};  ///< the first that contains the antenna counts; outside all: no fix
  double correlation_time = 0.0;     ///< s, first-order Gauss-Markov errors; 0: white
  /// s after a change of zone during which covariance and quality stay those last reported; not across a
  /// masked zone.
  double stale = 0.0;
  /// m, reported throughout in place of the true sigma (height: times the zone's vertical factor).
  std::optional<double> claimed_sigma = {};
};

/// Throws ConfigError naming the first thing wrong.
GnssConfig validated(GnssConfig config);

class GnssStream : public SensorStream {
 public:
  GnssStream(const GnssConfig& config, std::shared_ptr<const Motion> motion, const RunSetup& run);
  std::optional<Delivery> next() override;

 private:
  /// What the receiver says of its own accuracy.
  struct Claim {
    double sigma = 0.0;     ///< m
    double sigma_up = 0.0;  ///< m
    GnssFix::Quality quality = GnssFix::Quality::None;
  };
  std::optional<std::size_t> zoneAt(double t, const Eigen::Vector3d& p_map) const;
  void advanceError(double t);
  Claim claim(double t, std::size_t zone, const Claim& honest);
  GnssFix fix(const Eigen::Vector3d& p_map, const Claim& said) const;

  GnssConfig config_;
  std::shared_ptr<const Motion> motion_;
  map::LocalFrame frame_;
  Ticker ticker_;
  RandomStream noise_;
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();  ///< in sigmas
  std::optional<double> error_t_ = {};               ///< s, when error_ was drawn
  std::optional<std::size_t> zone_ = {};             ///< of the last fix
  double stale_until_ = 0.0;                         ///< s
  Claim last_claim_ = {};
};

}  // namespace pos::sim
