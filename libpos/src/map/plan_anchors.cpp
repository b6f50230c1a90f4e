#include "pos/map/plan_anchors.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"
#include "range_information.hpp"

namespace pos::map {
namespace {

/// Where an anchor hangs on the wall: in an arch the roof comes in above the springing.
double wallOffset(const Roadway& roadway, double height) {
  const double radius = 0.5 * roadway.width;
  const double above = height - (roadway.height - radius);
  if (roadway.section == Section::Rectangle || above <= 0.0) return radius;
  return std::sqrt(std::max(0.0, radius * radius - above * above));
}

std::vector<Anchor> places(const Network& network, const PlanRules& rules) {
  std::vector<Anchor> places;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Roadway& roadway = network.map().roadways[r];
    const Centreline& line = network.centreline(r);
    const double height = std::min(rules.anchor_height, roadway.height);
    const auto steps = static_cast<int>(std::max(1.0, std::round(line.length() / rules.candidate_step)));
    for (int i = 0; i <= steps; ++i) {
      const double chainage = line.chainageStart() + line.length() * i / steps;
      for (const double side : {1.0, -1.0}) {
        places.push_back({.p_map = network.toMap({r, chainage, side * wallOffset(roadway, height), height}),
                          .wall = side > 0.0 ? Wall::Left : Wall::Right});
      }
    }
  }
  return places;
}

/// Samples of all roadways, what is known at each from the anchors chosen so far, and what each place adds.
class Plan {
 public:
  Plan(const Network& network, const PlanRules& rules, const std::vector<CoverageSample>& samples)
      : rules_(rules), places_(places(network, rules)) {
    const double prior = 1.0 / (rules.coverage.singular_sigma * rules.coverage.singular_sigma);
    for (const CoverageSample& sample : samples) {
      const double heading = network.centreline(sample.point.roadway).at(sample.point.chainage).heading;
      Eigen::Matrix2d J = prior * Eigen::Matrix2d::Identity();
      for (const std::size_t a : network.visibleAnchors(sample.p_map, rules.coverage.range_limit))
        J += rangeInformation(sample.p_map, heading, network.map().anchors[a], rules.coverage.range_sigma);
      known_.push_back(J);
      p_map_.push_back(sample.p_map);
      heading_.push_back(heading);
    }
    addViews(network);
  }

  /// The place that gains most, or nothing when none gains.
  std::optional<std::size_t> best() const {
    std::optional<std::size_t> best;
    double most = 1e-6;
    for (std::size_t c = 0; c < places_.size(); ++c) {
      const double gained = chosen(c) ? 0.0 : gain(c);
      if (gained <= most) continue;
      most = gained;
      best = c;
    }
    return best;
  }

  void add(std::size_t place) {
    chosen_.push_back(place);
    for (const View& view : views_[place]) known_[view.sample] += view.J;
  }

  /// Takes away, from the first chosen on, whatever the target can do without.
  void thin() {
    const std::size_t needed = std::min(met(), neededSamples());
    for (std::size_t i = 0; i < chosen_.size();) {
      const std::size_t place = chosen_[i];
      for (const View& view : views_[place]) known_[view.sample] -= view.J;
      if (met() >= needed) {
        chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        for (const View& view : views_[place]) known_[view.sample] += view.J;
        ++i;
      }
    }
  }

  std::size_t met() const {
    return static_cast<std::size_t>(std::count_if(
        known_.begin(), known_.end(), [&](const Eigen::Matrix2d& J) { return deficit(J) <= 0.0; }));
  }
  std::size_t neededSamples() const {
    return static_cast<std::size_t>(std::ceil(rules_.met_share * static_cast<double>(known_.size()) - 1e-9));
  }
  std::size_t samples() const { return known_.size(); }
  std::vector<Anchor> anchors() const {
    std::vector<Anchor> anchors;
    for (const std::size_t place : chosen_) anchors.push_back(places_[place]);
    return anchors;
  }

 private:
  struct View {
    std::size_t sample = 0;
    Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
  };

  void addViews(const Network& network) {
    views_.resize(places_.size());
    for (std::size_t c = 0; c < places_.size(); ++c) {
      for (std::size_t s = 0; s < p_map_.size(); ++s) {
        const double range = (p_map_[s] - places_[c].p_map).norm();
        if (range > rules_.coverage.range_limit || !network.inSight(p_map_[s], places_[c].p_map)) continue;
        views_[c].push_back(
            {s, rangeInformation(p_map_[s], heading_[s], places_[c], rules_.coverage.range_sigma)});
      }
    }
  }

  bool chosen(std::size_t place) const {
    return std::find(chosen_.begin(), chosen_.end(), place) != chosen_.end();
  }

  /// By what factors (as logarithms) the bounds miss their targets, 0 when both are met.
  double deficit(const Eigen::Matrix2d& J) const {
    const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(0, 1);
    const double along = 0.5 * std::log(J(1, 1) / det) - std::log(rules_.along);
    const double across = 0.5 * std::log(J(0, 0) / det) - std::log(rules_.across);
    return std::max(0.0, along) + std::max(0.0, across);
  }

  double gain(std::size_t place) const {
    double sum = 0.0;
    for (const View& view : views_[place]) {
      const Eigen::Matrix2d& J = known_[view.sample];
      sum += deficit(J) - deficit(J + view.J);
    }
    return sum;
  }

  PlanRules rules_;
  std::vector<Anchor> places_;
  std::vector<std::vector<View>> views_;  ///< of each place
  std::vector<Eigen::Matrix2d> known_;    ///< of each sample
  std::vector<Eigen::Vector3d> p_map_;
  std::vector<double> heading_;
  std::vector<std::size_t> chosen_;
};

double totalLength(const Network& network) {
  double sum = 0.0;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) sum += network.centreline(r).length();
  return sum;
}

std::vector<Anchor> withIds(std::vector<Anchor> anchors, const TunnelMap& map) {
  AnchorId id = 0;
  for (const Anchor& anchor : map.anchors) id = std::max(id, anchor.id);
  for (Anchor& anchor : anchors) anchor.id = ++id;
  return anchors;
}

}  // namespace

PlanRules validated(PlanRules rules) {
  requireValid(rules.coverage, "coverage");
  requirePositive(rules.along, "along_m", "m");
  requirePositive(rules.across, "across_m", "m");
  requireShare(rules.met_share, "met_share");
  requirePositive(rules.met_share, "met_share");
  requirePositive(rules.candidate_step, "candidate_step_m", "m");
  requireNotNegative(rules.anchor_height, "anchor_height_m", "m");
  return rules;
}

double AnchorPlan::anchorsPerKilometre() const {
  return roadway_length > 0.0 ? 1000.0 * static_cast<double>(added.size()) / roadway_length : 0.0;
}

AnchorPlan plannedAnchors(const Network& network, const PlanRules& rules) {
  (void)validated(rules);
  const std::vector<CoverageSample> samples = coverage(network, rules.coverage);
  Plan plan(network, rules, samples);
  while (plan.met() < plan.neededSamples()) {
    const auto place = plan.best();
    if (!place) break;
    plan.add(*place);
  }
  plan.thin();
  TunnelMap with_plan = network.map();
  const std::vector<Anchor> added = withIds(plan.anchors(), with_plan);
  with_plan.anchors.insert(with_plan.anchors.end(), added.begin(), added.end());
  const Network planned(std::make_shared<const TunnelMap>(std::move(with_plan)));
  return {.added = added,
          .before = summary(samples),
          .after = summary(coverage(planned, rules.coverage)),
          .samples_met = plan.met(),
          .samples = plan.samples(),
          .met = plan.met() >= plan.neededSamples(),
          .roadway_length = totalLength(network)};
}

}  // namespace pos::map
