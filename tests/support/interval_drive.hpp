#pragma once
/// Scenario B-E5 of spec A section 7: a leg with two lanes, a branch, a bend, chamber passages of which some
/// are missed or name the wrong chamber, and a dead-reckoning filter with the errors of encoders and a gyro.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/interval/error_bound.hpp"
#include "pos/interval/interval_tracker.hpp"
#include "pos/interval/passages.hpp"
#include "pos/interval/road_aid.hpp"
#include "support/drift_filter.hpp"
#include "support/interval_demo.hpp"

namespace pos::testing {

enum class Aiding { None, Chambers, ChambersAndRoad };

struct DriveOptions {
  std::uint64_t seed = 1;
  bool into_branch = false;
  Aiding aiding = Aiding::ChambersAndRoad;
  double speed = 3.0;     ///< m/s
  double missing = 0.01;  ///< share of chamber passages
  double wrong = 0.005;
};

/// One moment of a drive.
struct DriveSample {
  double driven = 0.0;       ///< m since the start
  double since_fix = 0.0;    ///< m since the last accepted passage (or the start)
  double along = 0.0;        ///< m, error
  double across = 0.0;       ///< m, error
  double along_sigma = 0.0;  ///< m
  double across_sigma = 0.0;
  double along_bound = 0.0;  ///< m, spec A section 6.5 from the last accepted passage on
  double across_bound = 0.0;
  bool near_boundary = false;
  bool right_set = false;
};

struct DriveResult {
  std::vector<DriveSample> samples;
  int sightings = 0;
  int wrong_told = 0;
  int wrong_accepted = 0;
  int right_refused = 0;
  int missing_told = 0;       ///< passages the reader missed
  int missed_noted = 0;       ///< chambers noted as missed
  double decided_past = 0.0;  ///< m past the fork from which on the right branch was known
  int trace_grew = 0;         ///< passage fixes after which the covariance was larger
};

class IntervalDrive {
 public:
  explicit IntervalDrive(std::shared_ptr<const map::TunnelMap> demo)
      : network(demo), graph(network), intervals(map::divided(graph, network, map::DivisionRules{})) {}

  DriveResult run(const DriveOptions& options) const;

  map::Network network;
  map::RoadGraph graph;
  std::vector<map::LockInterval> intervals;
};

namespace detail {

/// The chambers a vehicle in its lane passes, with the driven distance at which it does.
struct PassedChamber {
  std::string id;
  double at = 0.0;
};

inline map::TunnelPoint truePlace(const IntervalDrive& scene, const Eigen::Vector3d& p, bool into_branch) {
  const map::Centreline::Foot main = scene.network.centreline(0).foot(p);
  if (into_branch) {
    const map::Centreline::Foot branch = scene.network.centreline(1).foot(p);
    const bool past =
        branch.beyond == 0.0 && branch.chainage > 0.0 && std::abs(branch.offset) < std::abs(main.offset);
    if (past) return {1, branch.chainage, branch.offset, 0.0};
  }
  return {0, main.chainage, main.offset, 0.0};
}

}  // namespace detail

inline DriveResult IntervalDrive::run(const DriveOptions& options) const {
  const DriftNoise noise;
  const map::Centreline line(drivenLine(options.into_branch));
  RandomStream random(options.seed, options.into_branch ? 1 : 0);
  const double scale = random.normal(0.0, noise.scale);
  const double bias = random.normal(0.0, noise.gyro_bias);
  const double wander = random.uniform(0.0, 0.4);
  const double phase = random.uniform(0.0, 2.0 * kPi);
  const auto truth = [&](double s) {
    const map::CentrelineState c = line.at(s);
    const double k = 2.0 * kPi / 90.0;
    const double aside = wander * std::sin(k * s + phase);
    const Eigen::Vector2d p =
        c.p_map.head<2>() + aside * Eigen::Vector2d(-std::sin(c.heading), std::cos(c.heading));
    return Pose2{p.x(), p.y(), wrapAngle(c.heading + std::atan(wander * k * std::cos(k * s + phase)))};
  };

  const Pose2 first = truth(0.0);
  DriftFilter filter(
      noise, {first.x + random.normal(0.0, noise.position), first.y + random.normal(0.0, noise.position),
              first.yaw + random.normal(0.0, noise.heading)});
  interval::IntervalTracker tracker(network, graph, intervals, {}, {});
  interval::PassageCheck passages(network, {});
  interval::RoadAid aid(network, {});
  DriveResult result;
  const double dt = 0.1;
  double last_fix = 0.0;
  double fix_heading = 0.0;
  double fix_width = kMainWidth;
  double before_chainage = -1.0;
  map::RoadwayIndex before_road = 0;
  std::vector<std::pair<double, std::string>> due;  // driven distance of a sighting, chamber told

  for (int k = 1; options.speed * dt * k < line.length(); ++k) {
    const double s = options.speed * dt * k;
    const Stamp stamp = stampFromSeconds(dt * k);
    const Pose2 before = truth(s - options.speed * dt);
    const Pose2 now = truth(s);
    const double way = (now.translation() - before.translation()).norm();
    filter.predict(
        way * (1.0 + scale) + random.normal(0.0, noise.odometer * std::sqrt(way)),
        wrapAngle(now.yaw - before.yaw) + bias * dt + random.normal(0.0, noise.gyro * std::sqrt(dt)), dt);
    interval::IntervalBelief belief = tracker.take(filter.estimate(stamp));

    const map::TunnelPoint place = detail::truePlace(*this, {now.x, now.y, 0.0}, options.into_branch);
    for (const map::Chamber& chamber : network.map().chambers) {
      const bool own_side = chamber.side == map::Side::Right;
      const bool passed = network.indexOf(chamber.place.roadway) == place.roadway &&
                          before_road == place.roadway && before_chainage < chamber.place.chainage &&
                          place.chainage >= chamber.place.chainage;
      if (!own_side || !passed) continue;
      ++result.sightings;
      if (random.bernoulli(options.missing)) {
        ++result.missing_told;
        continue;
      }
      std::string told = chamber.id;
      if (random.bernoulli(options.wrong)) {
        while (told == chamber.id)
          told = network.map().chambers[random.bits() % network.map().chambers.size()].id;
      }
      due.emplace_back(s, told);
      if (told != chamber.id) ++result.wrong_told;
    }
    before_chainage = place.chainage;
    before_road = place.roadway;

    for (const auto& [at, told] : due) {
      const interval::Passage passage = passages.judged({stamp, told}, tracker.road());
      const map::Chamber* chamber = network.map().findChamber(told);
      const bool right = network.indexOf(chamber->place.roadway) == place.roadway &&
                         std::abs(chamber->place.chainage - place.chainage) < 5.0;
      if (passage.verdict == interval::PassageVerdict::Accepted && !right) ++result.wrong_accepted;
      if (passage.verdict != interval::PassageVerdict::Accepted && right) ++result.right_refused;
      if (options.aiding == Aiding::None || !passage.fix) continue;
      PassageFix fix = std::get<PassageFix>(passage.fix->reading);
      // Sigma 0.3 m along the road: the place told is off by that much.
      const double heading = network.centreline(place.roadway).at(place.chainage).heading;
      fix.p_map.head<2>() += random.normal(0.0, 0.3) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
      const double trace = filter.tracePosition();
      if (filter.ingest(fix) == Verdict::Applied) {
        last_fix = s;
        fix_heading = heading;
        fix_width = network.map().roadways[place.roadway].width;
      }
      result.trace_grew += filter.tracePosition() > trace * (1.0 + 1e-12) ? 1 : 0;
    }
    due.clear();
    result.missed_noted += static_cast<int>(passages.missed(tracker.road()).size());
    if (options.aiding == Aiding::ChambersAndRoad) {
      if (const auto fix = aid.offered(filter.estimate(stamp), tracker.road()))
        (void)filter.ingest(std::get<PassageFix>(fix->reading));
    }

    const double past_fork = options.into_branch ? s - kForkDriven : place.chainage - 250.0;
    const bool known = belief.state == interval::MatchState::Decided && belief.point.roadway == place.roadway;
    if (past_fork > 0.0 && past_fork < 100.0 && !known) result.decided_past = past_fork + options.speed * dt;

    const Estimate after = filter.estimate(stamp);
    const double heading = network.centreline(place.roadway).at(place.chainage).heading;
    const Eigen::Vector2d t(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d error = after.T_map_body.translation.head<2>() - now.translation();
    const Matrix<2, 2> P = after.planarCovariance().topLeftCorner<2, 2>();
    DriveSample sample{.driven = s, .since_fix = s - last_fix, .along = error.dot(t)};
    sample.across = error.dot(Eigen::Vector2d(-t.y(), t.x()));
    sample.along_sigma = std::sqrt(t.dot(P * t));
    sample.across_sigma = std::sqrt(P.trace() - t.dot(P * t));
    // Bound of 6.5, turned by what the road has turned since the fix: at a turn across becomes along.
    const double turned = wrapAngle(heading - fix_heading);
    const interval::DriftModel drift{.reset_along = last_fix > 0.0 ? 0.45 : noise.position,
                                     .reset_across = fix_width / std::sqrt(12.0),
                                     .scale = noise.scale,
                                     .random_along = noise.odometer * noise.odometer,
                                     .heading = noise.heading,
                                     .gyro_bias = noise.gyro_bias,
                                     .gyro_noise = noise.gyro};
    const double along = interval::alongBound(drift, sample.since_fix);
    const double across = interval::acrossBound(drift, sample.since_fix, options.speed);
    sample.along_bound = std::hypot(std::cos(turned) * along, std::sin(turned) * across);
    sample.across_bound = std::hypot(std::sin(turned) * along, std::cos(turned) * across);
    const map::Lane lane = place.roadway == 0 ? map::Lane::Forward : map::Lane::Both;
    sample.right_set =
        belief.atLeast(0.5) == map::intervalsAt(intervals, place.roadway, place.chainage, lane);
    for (const map::LockInterval& interval : intervals) {
      for (const map::IntervalSpan& span : interval.spans) {
        for (const double end : {span.from, span.to}) {
          const double apart = span.roadway == place.roadway ? std::abs(end - place.chainage) : 1e9;
          sample.near_boundary = sample.near_boundary || apart <= 3.0 * sample.along_sigma;
        }
      }
    }
    result.samples.push_back(sample);
  }
  return result;
}

}  // namespace pos::testing
