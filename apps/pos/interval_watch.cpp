#include "interval_watch.hpp"

#include <algorithm>

#include "pos/core/error.hpp"

namespace pos::app {
namespace {
constexpr double kNamed = 0.5;  // an interval this probable is one of the set
}

std::shared_ptr<const IntervalGround> intervalGround(const std::shared_ptr<const map::TunnelMap>& map,
                                                     const io::IntervalsConfig& config) {
  if (map->roadways.empty()) {
    throw ConfigError(Complaint{.what = "intervals need a map with roadways",
                                .key = "intervals",
                                .got = map->name.empty() ? "no map" : "map " + map->name,
                                .suggestion = "name a map with roadways, or leave intervals out"});
  }
  const map::Network network(map);
  map::RoadGraph graph(network);
  auto intervals = map::divided(graph, network, config.division());
  return std::make_shared<const IntervalGround>(
      IntervalGround{std::move(graph), eval::IntervalScene{network, std::move(intervals)}});
}

IntervalWatch::IntervalWatch(std::shared_ptr<const IntervalGround> ground, const io::IntervalsConfig& config,
                             std::string estimator)
    : ground_(std::move(ground)),
      estimator_(std::move(estimator)),
      tracker_(ground_->scene.network, ground_->graph, ground_->scene.intervals, config.match(),
               config.rules()),
      aid_(ground_->scene.network, config.aid()),
      passages_(ground_->scene.network, {}),
      aiding_(config.aids(estimator_)),
      use_(config.passagesOf(estimator_)) {}

void IntervalWatch::openFile(const io::RunFolder& folder) {
  file_.emplace(folder.intervalsCsv(estimator_), ground_->scene.network.map(), ground_->scene.intervals);
}

void IntervalWatch::flush() {
  if (file_) file_->flush();
}

std::optional<interval::IntervalBelief> IntervalWatch::take(const Estimate& estimate) {
  const auto P = estimate.planarCovariance();
  if (!P.allFinite() || P(0, 0) + P(1, 1) <= 0.0)
    return std::nullopt;  // without a covariance nothing can be said
  interval::IntervalBelief belief = tracker_.take(estimate);
  eval::IntervalSample sample{
      .stamp = estimate.stamp,
      .matched = belief.state != interval::MatchState::Waiting && belief.state != interval::MatchState::Lost,
      .point = belief.point,
      .along_sigma = belief.along_sigma,
      .named = belief.atLeast(kNamed)};
  if (belief.next) sample.boundary_in = belief.next->seconds;
  if (keep_) record_.samples.push_back(std::move(sample));
  for (const interval::IntervalEvent& event : tracker_.events()) note(event);
  if (use_ == io::PassageUse::Checked) {
    for (const std::string& chamber : passages_.missed(tracker_.road()))
      lines_.push_back({estimate.stamp, estimator_, "passage_missed", "", chamber});
  }
  if (file_) file_->write(belief);
  return belief;
}

void IntervalWatch::note(const interval::IntervalEvent& event) {
  using Kind = interval::IntervalEvent::Kind;
  lines_.push_back(io::runEvent(event, estimator_, ground_->scene.intervals));
  if (!keep_) return;
  if (event.kind == Kind::Entry) {
    ++record_.entries;
    record_.visits.push_back({event.interval, event.at, event.at_sigma, {}});
  }
  if (event.kind == Kind::Exit) {
    ++record_.exits;
    const auto open = std::find_if(record_.visits.rbegin(), record_.visits.rend(), [&](const auto& visit) {
      return visit.interval == event.interval && !visit.left;
    });
    if (open != record_.visits.rend()) open->left = event.at;
  }
  if (event.kind == Kind::BranchDecided) {
    ++record_.branches;
    record_.branch_past = std::max(record_.branch_past, event.past_node);
  }
  if (event.kind == Kind::Lost) ++record_.lost;
}

std::optional<Measurement> IntervalWatch::offered(const Estimate& estimate) {
  return aiding_ ? aid_.offered(estimate, tracker_.road()) : std::nullopt;
}

io::PassageUse IntervalWatch::useOf(const Measurement& measurement) const {
  const auto* fix = std::get_if<PassageFix>(&measurement.reading);
  const bool chamber = fix != nullptr && ground_->scene.network.map().findChamber(fix->place) != nullptr;
  return chamber ? use_ : io::PassageUse::AsTold;
}

std::optional<Measurement> IntervalWatch::checked(const Measurement& measurement,
                                                  const std::optional<Estimate>& here) {
  const auto& fix = std::get<PassageFix>(measurement.reading);
  if (here) tracker_.road().take(*here);
  interval::Passage passage = passages_.judged({measurement.stamp, fix.place, fix.p_body}, tracker_.road());
  if (passage.verdict != interval::PassageVerdict::Accepted) {
    ++record_.passages_refused;
    lines_.push_back({measurement.stamp, estimator_, "passage_refused", measurement.sensor,
                      fix.place + ": " + std::string(name(passage.verdict))});
    return std::nullopt;
  }
  passage.fix->sensor = measurement.sensor;
  return std::move(passage.fix);
}

eval::IntervalRecord IntervalWatch::finish() {
  if (file_) file_->close();
  return std::move(record_);
}

}  // namespace pos::app
