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

/// ClosestApproach: the fix is stamped when the antenna was nearest, within sigma_time, and errs by `sigma`
/// along the direction of travel.
/// Reader (RFID): the read falls anywhere in the time within `radius`, uniformly; the fix errs by what the
/// vehicle then is away from the place.
enum class PassageStyle { ClosestApproach, Reader };

struct PassageConfig {
  std::string sensor = "passage";
  Timing timing = {.rate = 20.0};  ///< how often the distance is looked at
  PassageStyle style = PassageStyle::ClosestApproach;
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();  ///< m, FLU
  std::vector<PassagePlace> places = {};
  double radius = 10.0;       ///< m, farther passages are not seen
  double sigma = 0.3;         ///< m, along the way; ClosestApproach only
  double sigma_time = 0.0;    ///< s, of the moment; ClosestApproach only
  double sigma_across = 2.0;  ///< m, reported across the way and in height; nothing is drawn from it
  double missed_probability = 0.0;
  double wrong_probability = 0.0;  ///< of a detected passage carrying another place's name and position
};

/// Throws ConfigError naming the first thing wrong (two places of one name, wrong ids with a single place).
PassageConfig validated(PassageConfig config);

/// One fix a visit: from coming within `radius` to leaving it again. Reported covariance: along the way
/// sigma^2 + (speed sigma_time)^2, or radius^2 / 3 for a reader; across sigma_across^2.
class PassageStream : public SensorStream {
 public:
  PassageStream(const PassageConfig& config, std::shared_ptr<const Motion> motion, const RunSetup& run);
  std::optional<Delivery> next() override;

 private:
  struct Visit {
    bool open = false;
    double begin = 0.0;
    double nearest_t = 0.0;
    double nearest = 0.0;
  };
  double distance(std::size_t place, double t) const;
  void look(double t);
  void close(std::size_t place, double t);

  PassageConfig config_;
  std::shared_ptr<const Motion> motion_;
  Ticker ticker_;
  RandomStream choices_;
  RandomStream noise_;
  std::vector<Visit> visits_;
  std::deque<Delivery> ready_ = {};
  bool over_ = false;
};

}  // namespace pos::sim
