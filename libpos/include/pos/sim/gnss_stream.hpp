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
  double stale = 0.0;                ///< s after a change of zone during which covariance and quality stay
                                     ///< those last reported (not across a masked zone or a gap of fixes)
  std::optional<double> claimed_sigma = {};  ///< m, per axis; reported throughout in place of the true one
};

/// Throws ConfigError naming the first thing wrong.
GnssConfig validated(GnssConfig config);

class GnssStream : public SensorStream {
 public:
  GnssStream(const GnssConfig& config, std::shared_ptr<const Motion> motion, const RunSetup& run);
  std::optional<Delivery> next() override;

 private:
  struct Reported {
    std::size_t zone = 0;
    double sigma = 0.0;
    double sigma_up = 0.0;
    GnssFix::Quality quality = GnssFix::Quality::None;
  };
  std::optional<std::size_t> zoneAt(double t, const Eigen::Vector2d& p) const;
  Eigen::Vector3d unitError(double t);
  Reported reported(double t, const Reported& honest);

  GnssConfig config_;
  std::shared_ptr<const Motion> motion_;
  map::LocalFrame frame_;
  Ticker ticker_;
  RandomStream noise_;
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();  ///< in sigmas
  std::optional<double> last_error_t_ = {};
  std::optional<Reported> last_ = {};
  double last_fix_t_ = 0.0;
  double zone_entered_ = 0.0;
  std::optional<std::size_t> zone_ = {};
};

}  // namespace pos::sim
