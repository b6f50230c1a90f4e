#include "pos/uwb/rigid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "gauss_newton.hpp"
#include "linear_start.hpp"

namespace pos::uwb {
namespace {

using detail::Weights;

constexpr int kHeadings = 8;
constexpr std::size_t kFewestRanges = 4;
constexpr double kSamePlace = 1e-3;  // m and rad

struct BodyModel {
  std::span<const BodyRange> ranges;
  double body_height;

  auto at(const Vector<3>& q) const {
    return [this, q, c = std::cos(q[2]), s = std::sin(q[2])](int i) {
      const BodyRange& range = ranges[static_cast<std::size_t>(i)];
      const Eigen::Vector3d& l = range.tag_body;
      const double lever_x = c * l.x() - s * l.y();
      const double lever_y = s * l.x() + c * l.y();
      const double x = q[0] + lever_x - range.anchor_map.x();
      const double y = q[1] + lever_y - range.anchor_map.y();
      const double z = body_height + l.z() - range.anchor_map.z();
      const double distance = std::max(std::sqrt(x * x + y * y + z * z), 1e-9);
      return detail::Linearised<3>{range.range - distance,
                                   Vector<3>(x, y, y * lever_x - x * lever_y) / distance};
    };
  }

  Vector<3> start(const Vector<3>& q, const Weights& weights) const;
};

using MovedRanges = std::array<TagRange, kMaxRanges>;

/// With the heading given, a tag's range to an anchor is the body's range to an anchor moved by the lever
/// arm.
MovedRanges movedRanges(std::span<const BodyRange> ranges, double body_height, double yaw) {
  MovedRanges moved{};
  const Eigen::Matrix2d R = rotation2(yaw);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    moved[i] = tagRange(ranges[i], body_height);
    moved[i].anchor -= R * ranges[i].tag_body.head<2>();
  }
  return moved;
}

Vector<3> BodyModel::start(const Vector<3>& q, const Weights& weights) const {
  const MovedRanges moved = movedRanges(ranges, body_height, q[2]);
  const auto p = detail::linearStart({moved.data(), ranges.size()}, weights);
  return p ? Vector<3>(p->x(), p->y(), q[2]) : q;
}

/// The ranges of one tag as multilateration wants them, about the tag itself.
struct TagGroup {
  TagId tag = 0;
  Eigen::Vector3d tag_body = Eigen::Vector3d::Zero();
  std::array<TagRange, kMaxRanges> ranges{};
  std::size_t count = 0;

  std::span<const TagRange> all() const { return {ranges.data(), count}; }
};

/// The two tags with the most ranges.
struct Groups {
  std::array<TagGroup, 2> groups;
  int tags = 0;  ///< all of them
};

Groups groupsOf(std::span<const BodyRange> ranges, double body_height) {
  struct Tally {
    TagId tag;
    int count;
  };
  std::array<Tally, kMaxRanges> tallies{};
  int tags = 0;
  for (const BodyRange& range : ranges) {
    const auto end = tallies.begin() + tags;
    const auto found = std::find_if(tallies.begin(), end, [&](const Tally& t) { return t.tag == range.tag; });
    if (found == end)
      tallies[static_cast<std::size_t>(tags++)] = {range.tag, 1};
    else
      ++found->count;
  }
  std::stable_sort(tallies.begin(), tallies.begin() + tags,
                   [](const Tally& a, const Tally& b) { return a.count > b.count; });
  Groups result;
  result.tags = tags;
  for (std::size_t g = 0; g < 2 && static_cast<int>(g) < tags; ++g) {
    TagGroup& group = result.groups[g];
    group.tag = tallies[g].tag;
    for (const BodyRange& range : ranges) {
      if (range.tag != group.tag) continue;
      group.tag_body = range.tag_body;
      group.ranges[group.count++] = tagRange(range, body_height);
    }
  }
  return result;
}

bool same(const Vector<3>& a, const Vector<3>& b) {
  return (a - b).head<2>().norm() < kSamePlace && std::abs(wrapAngle(a[2] - b[2])) < kSamePlace;
}

class Search {
 public:
  Search(std::span<const BodyRange> ranges, double body_height, const ResidualTest& test)
      : model_{ranges, body_height}, weights_(detail::weightsOf(ranges)), test_(test) {}

  /// With the search for bad ranges.
  void add(const Vector<3>& start) { keep(detail::robustFit<3>(model_, start, weights_, test_)); }

  /// Without it: only a pose that all ranges agree on. Starts on the wrong side of a line of anchors are
  /// cheap so.
  void addPlain(const Vector<3>& start) {
    const detail::Fit<3> fit = detail::fitted<3>(model_, start, weights_);
    const int used = detail::counted(weights_);
    if (fit.solved && test_.passes(fit.normal.cost, used - 3)) keep({fit, weights_, used, true, 1.0});
  }

  /// A pose that leaves no range out needs no further search.
  bool good() const {
    return found_.count > 0 && found_.fixes[0].consistent &&
           std::popcount(found_.fixes[0].used) == static_cast<int>(weights_.size());
  }

  RigidFixes judged() {
    found_.verdict = FixVerdict::Degenerate;
    if (found_.count == 0) return found_;
    const double best = against(found_.fixes[0]);
    while (found_.count > 1 && against(found_.fixes[last()]) > best + kRuledOut) --found_.count;
    found_.verdict = found_.count == 1 ? FixVerdict::Solved : FixVerdict::Ambiguous;
    return found_;
  }

 private:
  std::size_t last() const { return static_cast<std::size_t>(found_.count) - 1; }

  void keep(const detail::RobustFit<3>& robust) {
    RigidFix fix;
    if (!robust.fit.solved || !detail::invert<3>(robust.fit.normal.information, fix.pose.covariance)) return;
    Vector<3> q = robust.fit.x;
    q[2] = wrapAngle(q[2]);
    for (const RigidFix& other : found_.all()) {
      if (same(q, {other.pose.mean.x, other.pose.mean.y, other.pose.mean.yaw})) return;
    }
    fix.pose.mean = {q[0], q[1], q[2]};
    fix.pose.covariance *= robust.inflation;
    fix.chi_square = robust.fit.normal.cost;
    fix.dof = robust.used - 3;
    fix.used = detail::maskOf(robust.weights);
    fix.consistent = robust.consistent;
    sortIn(fix);
  }

  double against(const RigidFix& fix) const {
    return detail::against(fix, static_cast<std::size_t>(weights_.size()));
  }

  /// Sorted by what speaks against them; the worst falls off the end.
  void sortIn(const RigidFix& fix) {
    if (found_.count == 4) {
      if (against(fix) >= against(found_.fixes[3])) return;
      --found_.count;
    }
    std::size_t place = static_cast<std::size_t>(found_.count++);
    for (; place > 0 && against(fix) < against(found_.fixes[place - 1]); --place) {
      found_.fixes[place] = found_.fixes[place - 1];
    }
    found_.fixes[place] = fix;
  }

  BodyModel model_;
  Weights weights_;
  const ResidualTest& test_;
  RigidFixes found_;
};

/// Position and heading that lay the body's baseline along the one between two tag positions.
Vector<3> startBetween(const TagGroup& a, const Eigen::Vector2d& p_a, const TagGroup& b,
                       const Eigen::Vector2d& p_b) {
  const Eigen::Vector2d lever_a = a.tag_body.head<2>();
  const Eigen::Vector2d lever_b = b.tag_body.head<2>();
  const Eigen::Vector2d baseline_body = lever_a - lever_b;
  const Eigen::Vector2d baseline_map = p_a - p_b;
  const double yaw =
      std::atan2(baseline_map.y(), baseline_map.x()) - std::atan2(baseline_body.y(), baseline_body.x());
  const Eigen::Vector2d p = 0.5 * (p_a + p_b) - rotation2(yaw) * (0.5 * (lever_a + lever_b));
  return {p.x(), p.y(), yaw};
}

struct TagStarts {
  std::array<Vector<3>, 4> poses;
  std::size_t count = 0;

  std::span<const Vector<3>> all() const { return {poses.data(), count}; }
};

/// Both tags by themselves, both sides of a line of anchors each.
TagStarts startsFromTags(const Groups& groups) {
  const auto& [a, b] = groups.groups;
  const detail::Starts first = detail::startingPlaces(a.all(), detail::weightsOf(a.all()));
  const detail::Starts second = detail::startingPlaces(b.all(), detail::weightsOf(b.all()));
  TagStarts starts;
  for (const Eigen::Vector2d& p_a : first.all()) {
    for (const Eigen::Vector2d& p_b : second.all())
      starts.poses[starts.count++] = startBetween(a, p_a, b, p_b);
  }
  return starts;
}

void startFromHeadings(Search& search, std::span<const BodyRange> ranges, double body_height) {
  for (int k = 0; k < kHeadings; ++k) {
    const double yaw = 2.0 * kPi * k / kHeadings;
    const MovedRanges moved = movedRanges(ranges, body_height, yaw);
    const detail::Starts starts =
        detail::startingPlaces({moved.data(), ranges.size()}, detail::weightsOf(ranges));
    for (const Eigen::Vector2d& p : starts.all()) search.add({p.x(), p.y(), yaw});
  }
}

}  // namespace

TagRange tagRange(const BodyRange& range, double body_height) {
  return {range.anchor_map.head<2>(), range.anchor_map.z() - body_height - range.tag_body.z(), range.range,
          range.sigma};
}

RangeRow predictedRange(const Pose2& pose, double body_height, const Eigen::Vector3d& tag_body,
                        const Eigen::Vector3d& anchor_map) {
  const BodyRange range{0, tag_body, anchor_map, 0.0, 1.0};
  const BodyModel model{{&range, 1}, body_height};
  const auto linearised = model.at({pose.x, pose.y, pose.yaw})(0);
  return {-linearised.residual, linearised.row};
}

RigidFixes rigidFixes(std::span<const BodyRange> ranges, double body_height, const ResidualTest& test) {
  if (ranges.size() < kFewestRanges) return {};
  const Groups groups = groupsOf(ranges, body_height);
  if (groups.tags < 2) return {};
  Search search(ranges, body_height, test);
  const TagStarts starts = groups.groups[1].count >= 2 ? startsFromTags(groups) : TagStarts{};
  for (const Vector<3>& start : starts.all()) search.addPlain(start);
  if (search.good()) return search.judged();
  for (const Vector<3>& start : starts.all()) search.add(start);
  startFromHeadings(search, ranges, body_height);
  return search.judged();
}

RigidFixes rigidFixNear(std::span<const BodyRange> ranges, double body_height, const Pose2& start,
                        const ResidualTest& test) {
  if (ranges.size() < kFewestRanges) return {};
  Search search(ranges, body_height, test);
  search.add({start.x, start.y, start.yaw});
  return search.judged();
}

}  // namespace pos::uwb
