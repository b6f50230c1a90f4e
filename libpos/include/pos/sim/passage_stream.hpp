#pragma once
/// Simulated detections of known places: beacons at refuge chambers, portal readers (spec A, 6.4).

#include <deque>
#include <memory>
#include <vector>

#include "pos/sim/motion.hpp"
#include "pos/sim/timing.hpp"

namespace pos::sim {

/// A place that can be detected.
struct PassagePlace {
  std::string name = {};
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, the point of the roadway that a passage fixes
};

/// ClosestApproach: recognised once the antenna has come nearest and gone `rise` farther again; stamped with
/// the nearest moment, within sigma_time; errs by `sigma` along the way. Reader (RFID): read at a distance
/// from the place uniform in (0, radius), on the way in or out with equal chance; at once when the vehicle
/// stands within `radius`.
enum class PassageStyle { ClosestApproach, Reader };

struct PassageConfig {
  std::string sensor = "passage";
  Timing timing = {.rate = 20.0};  ///< how often the distance is looked at
  PassageStyle style = PassageStyle::ClosestApproach;
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();  ///< m, FLU
  std::vector<PassagePlace> places = {};
  double radius = 10.0;       ///< m, farther passages are not seen
  double rise = 1.0;          ///< m; ClosestApproach only
  double sigma = 0.3;         ///< m, along the way; ClosestApproach only
  double sigma_time = 0.0;    ///< s, of the moment; ClosestApproach only
  double sigma_across = 2.0;  ///< m, reported across the way and in height; nothing is drawn from it
  double missed_probability = 0.0;
  double wrong_probability = 0.0;  ///< of a detected passage carrying another place's name and position
};

/// Throws ConfigError naming the first thing wrong (two places of one name, wrong ids with a single place).
PassageConfig validated(PassageConfig config);

/// At most one fix a visit, from coming within `radius` of a place to leaving it. The fix says that the
/// antenna was at the place's point. Reported covariance: along the way sigma^2 + (speed sigma_time)^2, or
/// radius^2 / 3 for a reader; across sigma_across^2. An outage swallows the fixes recognised in it.
class PassageStream : public SensorStream {
 public:
  PassageStream(const PassageConfig& config, std::shared_ptr<const Motion> motion, const RunSetup& run);
  std::optional<Delivery> next() override;

 private:
  struct Visit {
    bool open = false;
    bool done = false;
    double begin = 0.0;      ///< s
    double nearest_t = 0.0;  ///< s
    double nearest = 0.0;    ///< m
    double read_at = 0.0;    ///< m, Reader only
    bool read_leaving = false;
    bool missed = false;
    std::size_t told = 0;  ///< the place that the fix will name
  };
  double distance(std::size_t place, const Kinematics& body) const;
  Visit begun(std::size_t place, double t, double d);
  /// The moment of detection, once there is one.
  std::optional<double> detected(std::size_t place, const Visit& visit, double t, double d) const;
  double closestApproach(std::size_t place, const Visit& visit) const;
  PassageFix fix(const PassagePlace& told, double t);
  void look(std::size_t place, const Tick& tick, const Kinematics& body);

  PassageConfig config_;
  std::shared_ptr<const Motion> motion_;
  Ticker ticker_;
  RandomStream choices_;
  RandomStream noise_;
  std::vector<Visit> visits_;
  std::deque<Delivery> ready_ = {};
};

}  // namespace pos::sim
