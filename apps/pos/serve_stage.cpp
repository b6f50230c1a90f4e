#include "serve_stage.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "pos/estimation/factory.hpp"
#include "pos/eval/association.hpp"
#include "pos/serve/request.hpp"

namespace pos::app {
namespace {

using Json = nlohmann::ordered_json;

Json secondsOrNull(const std::optional<Stamp>& stamp) {
  return stamp ? Json(secondsSinceOrigin(*stamp)) : Json(nullptr);
}

}  // namespace

std::optional<Pose3> Reference::at(Stamp stamp) const {
  return eval::interpolate(truth_, stamp, max_gap_);
}

void Reference::compare(serve::TrackRow& row) const {
  if (const auto pose = at(row.stamp)) serve::compare(row, *pose, tangent_.at(row.stamp));
}

Scenery sceneryOf(const Inputs& inputs, serve::Mode mode, const std::optional<LockedVehicle>& vehicle) {
  Scenery scenery{.mode = mode, .name = inputs.config.name, .map_name = inputs.map->name};
  for (const io::EstimatorEntry& entry : inputs.config.estimators)
    scenery.estimators.push_back({entry.name, std::string(estimation::typeName(entry.config))});
  for (const map::Roadway& roadway : inputs.map->roadways) scenery.names.roadways.push_back(roadway.id);
  for (const map::Anchor& anchor : inputs.map->anchors) scenery.anchors.push_back(anchor.id);
  if (!inputs.map->roadways.empty()) {
    const io::IntervalsConfig config = inputs.config.intervals.value_or(io::IntervalsConfig{});
    const auto ground = intervalGround(inputs.map, config);
    scenery.network = ground->scene.network;
    scenery.names.intervals = ground->scene.intervals;
    if (vehicle) scenery.locks = std::make_shared<const LockedRoute>(*ground, *vehicle);
  }
  if (inputs.truth && !inputs.truth->poses.empty())
    scenery.reference.emplace(*inputs.truth, durationFromSeconds(inputs.config.evaluation.max_gap));
  scenery.intervals = inputs.config.intervals.has_value();
  return scenery;
}

Stage::Stage(Scenery scenery)
    : scenery_(std::move(scenery)),
      tested_(scenery_.estimators.size()),
      tracks_(scenery_.estimators.size() + 1) {
  clear();
  if (!scenery_.reference) return;
  for (const TruthPose& pose : scenery_.reference->truth().poses) truth(pose);
}

void Stage::clear() {
  watch_.reset();
  if (scenery_.locks) watch_.emplace(scenery_.locks);
  const std::unique_lock lock(mutex_);
  states_.clear();
  for (const Scenery::Title& title : scenery_.estimators)
    states_.push_back({.name = title.name, .type = title.type});
  tested_.assign(states_.size(), {});
  for (std::size_t i = 0; i < states_.size(); ++i) tracks_[i].clear();
  locks_.clear();
  events_.clear();
  ++resets_;
}

void Stage::verdict(std::size_t estimator, const Measurement&, const IngestReport& report) {
  const std::unique_lock lock(mutex_);
  serve::EstimatorState& state = states_[estimator];
  ++state.verdicts[static_cast<std::size_t>(report.verdict)];
  if (report.verdict == Verdict::Gated) ++tested_[estimator].gated;
  const bool tested = report.verdict == Verdict::Gated || report.verdict == Verdict::Applied;
  if (!tested || report.dof <= 0) return;
  state.nis = report.nis / report.dof;
  tested_[estimator].nis += *state.nis;
  ++tested_[estimator].tested;
}

/// Roadway and chainage by the map alone.
void Stage::locate(serve::TrackRow& row, const Eigen::Vector3d& p_map) const {
  if (!scenery_.network) return;
  const auto projection = scenery_.network->project(p_map);
  if (!projection || projection->excess > 5.0) return;
  row[serve::Column::Roadway] = static_cast<float>(projection->point.roadway);
  row[serve::Column::Chainage] = static_cast<float>(projection->point.chainage);
  const auto held = map::intervalsAt(scenery_.names.intervals, projection->point.roadway,
                                     projection->point.chainage, map::Lane::Both);
  if (!held.empty()) row[serve::Column::Interval] = static_cast<float>(held.front());
}

/// By the lock rules where the vehicle's route is known, else by its place alone.
std::vector<serve::Occupancy> Stage::lockStates(const Estimate& estimate,
                                                const std::optional<interval::IntervalBelief>& belief) {
  if (watch_) return watch_->take(estimate);
  std::vector<serve::Occupancy> states;
  for (std::size_t i = 0; belief && i < scenery_.names.intervals.size(); ++i)
    states.push_back(serve::occupancy(*belief, i));
  return states;
}

void Stage::estimate(std::size_t estimator, const Estimate& estimate,
                     const std::optional<interval::IntervalBelief>& belief) {
  serve::TrackRow row = serve::rowOf(estimate);
  if (scenery_.reference) scenery_.reference->compare(row);
  if (belief) serve::place(row, *belief);
  if (!belief) locate(row, estimate.T_map_body.translation);
  std::vector<serve::Occupancy> locks;
  if (estimator == 0) locks = lockStates(estimate, belief);
  const std::unique_lock lock(mutex_);
  if (!locks.empty() && (locks_.empty() || locks_.back().states != locks))
    locks_.push_back({estimate.stamp, std::move(locks)});
  const Tested tested = std::exchange(tested_[estimator], {});
  row[serve::Column::Gated] = static_cast<float>(tested.gated);
  if (tested.tested > 0) row[serve::Column::Nis] = static_cast<float>(tested.nis / tested.tested);
  tracks_[estimator].append(row);
  serve::EstimatorState& state = states_[estimator];
  state.estimate = estimate;
  state.place = belief;
  const float error = row[serve::Column::Error];
  state.error = std::isfinite(error) ? std::optional<double>(error) : std::nullopt;
}

void Stage::modes(std::size_t estimator, Diagnostics modes) {
  const std::unique_lock lock(mutex_);
  states_[estimator].modes = std::move(modes);
}

void Stage::truth(const TruthPose& pose) {
  serve::TrackRow row = serve::rowOf(pose);
  locate(row, pose.T_map_body.translation);
  const std::unique_lock lock(mutex_);
  if (!tracks_.back().last() || *tracks_.back().last() < pose.stamp) tracks_.back().append(row);
}

void Stage::event(io::RunEvent event) {
  const std::unique_lock lock(mutex_);
  events_.add(std::move(event));
}

void Stage::setSpan(std::optional<Stamp> first, std::optional<Stamp> last) {
  const std::unique_lock lock(mutex_);
  first_ = first;
  last_ = last;
}

std::vector<serve::EstimatorState> Stage::estimators() const {
  const std::shared_lock lock(mutex_);
  return states_;
}

std::vector<serve::Occupancy> Stage::locks() const {
  const std::shared_lock lock(mutex_);
  return locks_.empty() ? std::vector<serve::Occupancy>{} : locks_.back().states;
}

std::vector<serve::Occupancy> Stage::locksAt(Stamp stamp) const {
  const std::shared_lock lock(mutex_);
  const auto after = std::upper_bound(locks_.begin(), locks_.end(), stamp,
                                      [](Stamp t, const LockChange& change) { return t < change.stamp; });
  return after == locks_.begin() ? std::vector<serve::Occupancy>{} : std::prev(after)->states;
}

std::string Stage::lockChangesJson() const {
  const std::shared_lock lock(mutex_);
  Json list = Json::array();
  for (const LockChange& change : locks_) {
    Json states = Json::array();
    for (const serve::Occupancy state : change.states) states.push_back(serve::name(state));
    list.push_back({{"stamp_s", secondsSinceOrigin(change.stamp)}, {"states", std::move(states)}});
  }
  return list.dump();
}

std::optional<Pose3> Stage::truthAt(Stamp stamp) const {
  return scenery_.reference ? scenery_.reference->at(stamp) : std::nullopt;
}

std::optional<Stamp> Stage::first() const {
  const std::shared_lock lock(mutex_);
  return first_;
}
std::optional<Stamp> Stage::last() const {
  const std::shared_lock lock(mutex_);
  return last_;
}
std::uint64_t Stage::events() const {
  const std::shared_lock lock(mutex_);
  return events_.total();
}
std::uint64_t Stage::resets() const {
  const std::shared_lock lock(mutex_);
  return resets_;
}

std::string Stage::eventsJson(std::uint64_t after, std::size_t limit) const {
  const std::shared_lock lock(mutex_);
  return events_.json(after, limit);
}

std::string Stage::tracksJson() const {
  const std::shared_lock lock(mutex_);
  Json list = Json::array();
  const auto add = [&](std::string_view name, const serve::Track& track) {
    list.push_back({{"name", name},
                    {"rows", track.rows()},
                    {"first_s", secondsOrNull(track.first())},
                    {"last_s", secondsOrNull(track.last())}});
  };
  if (tracks_.back().rows() > 0) add(kTruth, tracks_.back());
  for (std::size_t i = 0; i < scenery_.estimators.size(); ++i) add(scenery_.estimators[i].name, tracks_[i]);
  return Json{{"tracks", list}}.dump();
}

std::size_t Stage::trackOf(const std::string& name) const {
  for (std::size_t i = 0; i < scenery_.estimators.size(); ++i) {
    if (scenery_.estimators[i].name == name) return i;
  }
  if (name == kTruth && tracks_.back().rows() > 0) return tracks_.size() - 1;
  throw serve::notFound("there is no track '" + name + "'");
}

std::string Stage::packed(const std::string& track, const serve::TrackWindow& window) const {
  const std::shared_lock lock(mutex_);
  return tracks_[trackOf(track)].packed(window);
}

}  // namespace pos::app
