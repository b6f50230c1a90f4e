#include "pos/eval/interval_figures.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"

namespace pos::eval {
namespace {

constexpr double kClearSigmas = 3.0;
constexpr double kWallSlack = 0.5;      // m, a truth this far in the rock is still on the road
constexpr double kSameCrossing = 15.0;  // s, an entry told farther off than this is of another crossing

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

map::Lane laneOf(const map::Network& network, map::RoadwayIndex roadway, double chainage, double yaw) {
  if (network.map().roadways[roadway].lanes == 1) return map::Lane::Both;
  const double turned = wrapAngle(yaw - network.centreline(roadway).at(chainage).heading);
  return std::abs(turned) < 0.5 * kPi ? map::Lane::Forward : map::Lane::Backward;
}

/// Metres along the roadway to the nearest end of any interval there.
double toBoundary(const IntervalScene& scene, const TrueInterval& place) {
  double nearest = 1e9;
  for (const map::LockInterval& interval : scene.intervals) {
    for (const map::IntervalSpan& span : interval.spans) {
      if (span.roadway != place.roadway) continue;
      nearest = std::min({nearest, std::abs(span.from - place.chainage), std::abs(span.to - place.chainage)});
    }
  }
  return nearest;
}

/// When the truth entered intervals: every stamp at which one joins the set.
class TrueEntries {
 public:
  void take(Stamp stamp, const std::vector<std::size_t>& now) {
    if (known_) {
      for (const std::size_t i : now) {
        if (!std::binary_search(before_.begin(), before_.end(), i))
          all_.push_back({i, last_ + (stamp - last_) / 2});
      }
    }
    known_ = true;
    before_ = now;
    last_ = stamp;
  }

  /// s, told minus true; nothing where no crossing is near enough.
  std::optional<double> off(const IntervalVisit& visit) const {
    std::optional<double> best;
    for (const auto& [interval, stamp] : all_) {
      const double away = seconds(visit.entered - stamp);
      if (interval == visit.interval && std::abs(away) < kSameCrossing &&
          (!best || std::abs(away) < std::abs(*best)))
        best = away;
    }
    return best;
  }

 private:
  struct Entry {
    std::size_t interval = 0;
    Stamp stamp = {};
  };
  std::vector<Entry> all_;
  std::vector<std::size_t> before_;
  Stamp last_ = {};
  bool known_ = false;
};

void judge(IntervalFigures& f, const IntervalScene& scene, const Truth& truth,
           const AssociationOptions& association) {
  TrueEntries entries;
  for (const IntervalSample& sample : f.record.samples) {
    const auto pose = interpolate(truth, sample.stamp + association.time_offset, association.max_truth_gap);
    const auto place = pose ? trueInterval(scene, *pose, truth.has_z) : std::nullopt;
    if (!place) continue;
    entries.take(sample.stamp, place->intervals);
    const bool right = sample.named == place->intervals;
    const bool clear = toBoundary(scene, *place) > kClearSigmas * sample.along_sigma;
    ++f.judged;
    f.right += right ? 1 : 0;
    f.judged_clear += clear ? 1 : 0;
    f.right_clear += clear && right ? 1 : 0;
  }
  double squares = 0.0;
  for (const IntervalVisit& visit : f.record.visits) {
    const auto off = entries.off(visit);
    if (!off) continue;
    ++f.entries_matched;
    squares += *off * *off;
  }
  if (f.entries_matched > 0) f.entry_time_rmse = std::sqrt(squares / static_cast<double>(f.entries_matched));
}

}  // namespace

std::optional<double> IntervalFigures::rightShare() const {
  return share(right, judged);
}
std::optional<double> IntervalFigures::rightShareClear() const {
  return share(right_clear, judged_clear);
}
std::optional<double> IntervalFigures::entryTimeRmse() const {
  return entries_matched > 0 ? std::optional(entry_time_rmse) : std::nullopt;
}

std::optional<TrueInterval> trueInterval(const IntervalScene& scene, const Pose3& T_map_body, bool has_z) {
  const Eigen::Vector3d& p = T_map_body.translation;
  std::optional<map::Projection> best;
  for (const map::Projection& candidate : scene.network.candidates(p, has_z ? kWallSlack : 1e4)) {
    const double width = scene.network.map().roadways[candidate.point.roadway].width;
    const bool beside = std::abs(candidate.point.offset) <= 0.5 * width + kWallSlack;
    if (!beside || candidate.beyond > kWallSlack) continue;
    if (!best || std::abs(candidate.point.offset) < std::abs(best->point.offset)) best = candidate;
  }
  if (!best) return std::nullopt;
  TrueInterval place{best->point.roadway, best->point.chainage, {}};
  place.intervals = map::intervalsAt(scene.intervals, place.roadway, place.chainage,
                                     laneOf(scene.network, place.roadway, place.chainage, T_map_body.yaw()));
  std::sort(place.intervals.begin(), place.intervals.end());
  return place;
}

IntervalFigures intervalFigures(IntervalRecord record, const IntervalScene& scene, const Truth* truth,
                                const AssociationOptions& association) {
  IntervalFigures f;
  f.record = std::move(record);
  const auto& samples = f.record.samples;
  const auto matched = std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.matched; });
  f.matched_share = share(static_cast<std::size_t>(matched), samples.size()).value_or(0.0);
  if (truth != nullptr && !truth->poses.empty()) judge(f, scene, *truth, association);
  return f;
}

}  // namespace pos::eval
