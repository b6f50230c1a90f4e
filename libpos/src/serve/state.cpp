#include "pos/serve/state.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "json_parts.hpp"
#include "place_words.hpp"

namespace pos::serve {
namespace {

using interval::IntervalBelief;
using interval::MatchState;

std::string_view nameOf(MatchState state) {
  switch (state) {
    case MatchState::Waiting:
      return "waiting";
    case MatchState::Decided:
      return "decided";
    case MatchState::Branching:
      return "branching";
    case MatchState::Lost:
      return "lost";
  }
  return "";
}

Json poseJson(const Pose3& pose) {
  return {{"x_m", number(pose.translation.x())},
          {"y_m", number(pose.translation.y())},
          {"z_m", number(pose.translation.z())},
          {"yaw_rad", number(pose.yaw())}};
}

Json sigmaJson(const Matrix<3, 3>& P) {
  const double x = std::sqrt(std::max(0.0, P(0, 0)));
  const double y = std::sqrt(std::max(0.0, P(1, 1)));
  return {{"x_m", number(x)},
          {"y_m", number(y)},
          {"yaw_rad", number(std::sqrt(std::max(0.0, P(2, 2))))},
          {"corr_x_y", number(x > 0.0 && y > 0.0 ? P(0, 1) / (x * y) : 0.0)}};
}

/// One standard deviation; eigenvalues come in rising order.
Json ellipseJson(const Matrix<3, 3>& P) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(Eigen::Matrix2d(P.topLeftCorner<2, 2>()));
  const Eigen::Vector2d lengths = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector2d axis = solver.eigenvectors().col(1);
  return {{"major_m", number(lengths[1])},
          {"minor_m", number(lengths[0])},
          {"angle_rad", number(std::atan2(axis.y(), axis.x()))}};
}

Json listed(const IntervalBelief& belief, const Names& names) {
  Json list = Json::array();
  for (const auto& [interval, probability] : belief.intervals) {
    list.push_back({{"id", names.intervals[interval].id},
                    {"label", names.intervals[interval].label()},
                    {"probability", number(probability)}});
  }
  return list;
}

Json nextJson(const IntervalBelief& belief, const Names& names) {
  if (!belief.next) return nullptr;
  const map::LockInterval& interval = names.intervals[belief.next->interval];
  return {{"id", interval.id},
          {"label", interval.label()},
          {"entry", belief.next->entry},
          {"distance_m", number(belief.next->distance)},
          {"in_s", number(belief.next->seconds)}};
}

Json placeJson(const std::optional<IntervalBelief>& place, const Names& names,
               const std::vector<Occupancy>& locks) {
  if (!place) return nullptr;
  const bool known = knowsPlace(*place);
  const bool in_interval = known && !place->intervals.empty();
  const std::size_t best = in_interval ? place->intervals.front().interval : 0;
  const auto if_known = [&](double value) { return known ? number(value) : Json(nullptr); };
  return {{"state", nameOf(place->state)},
          {"roadway", known ? Json(names.roadways[place->point.roadway]) : Json(nullptr)},
          {"chainage_m", if_known(place->point.chainage)},
          {"offset_m", if_known(place->point.offset)},
          {"sigma_along_m", if_known(place->along_sigma)},
          {"against_chainage", known ? Json(place->against_chainage) : Json(nullptr)},
          {"interval", in_interval ? Json(names.intervals[best].label()) : Json(nullptr)},
          {"interval_id", in_interval ? Json(names.intervals[best].id) : Json(nullptr)},
          {"lock", in_interval ? name(lockState(*place, best, locks)) : name(Occupancy::Unknown)},
          {"intervals", known ? listed(*place, names) : Json::array()},
          {"next", nextJson(*place, names)},
          {"words", words(*place, names, locks)}};
}

Json modesJson(const Diagnostics& modes) {
  Json list = Json::array();
  for (const NamedValue& mode : modes)
    list.push_back({{"name", mode.name}, {"probability", number(mode.value)}});
  return list;
}

Json activeMode(const Diagnostics& modes) {
  const auto best = std::max_element(modes.begin(), modes.end(),
                                     [](const auto& a, const auto& b) { return a.value < b.value; });
  return best != modes.end() ? Json(best->name) : Json(nullptr);
}

Json estimatorJson(const EstimatorState& state, const std::optional<Stamp>& now, const Names& names,
                   const std::vector<Occupancy>& locks) {
  Json json{{"name", state.name}, {"type", state.type}};
  const std::optional<Estimate>& e = state.estimate;
  const Matrix<3, 3> P = e ? e->planarCovariance() : Matrix<3, 3>::Zero();
  json["stamp_s"] = e ? Json(secondsSinceOrigin(e->stamp)) : Json(nullptr);
  json["age_s"] = e && now ? number(seconds(*now - e->stamp)) : Json(nullptr);
  json["pose"] = e ? poseJson(e->T_map_body) : Json(nullptr);
  json["sigma"] = e ? sigmaJson(P) : Json(nullptr);
  json["ellipse"] = e ? ellipseJson(P) : Json(nullptr);
  json["speed_m_per_s"] = e && e->twist ? number(e->twist->rates.x()) : Json(nullptr);
  json["error_m"] = number(state.error);
  json["nis"] = number(state.nis);
  for (const Verdict verdict : kVerdicts)
    json["verdicts"][std::string(name(verdict))] = state.verdicts[static_cast<std::size_t>(verdict)];
  json["modes"] = modesJson(state.modes);
  json["mode"] = activeMode(state.modes);
  json["place"] = placeJson(state.place, names, locks);
  return json;
}

Json linkJson(const Link& link) {
  return {{"state", name(link.state)},
          {"age_s", number(link.age)},
          {"period_s", number(link.period)},
          {"count", link.count},
          {"gated_ratio", number(link.gated_ratio)}};
}

std::string_view seenWord(const Link& link) {
  const bool silent =
      link.state == Connection::Waiting || link.state == Connection::Stale || link.state == Connection::Lost;
  if (silent) return "not_seen";
  return link.last_tested == Verdict::Gated ? "rejected" : "seen";
}

Json sourcesJson(const Connections& connections) {
  Json list = Json::array();
  for (const SourceLink& source : connections.sources) {
    Json json{{"name", source.name}, {"kind", source.kind}};
    json.update(linkJson(source.link));
    json["refused"] = source.link.refused;
    json["why"] = source.link.why;
    list.push_back(std::move(json));
  }
  return list;
}

Json anchorsJson(const Connections& connections) {
  Json list = Json::array();
  for (const AnchorLink& anchor : connections.anchors) {
    Json json{{"id", anchor.id}};
    json.update(linkJson(anchor.link));
    json["seen"] = seenWord(anchor.link);
    list.push_back(std::move(json));
  }
  return list;
}

Json locksJson(const Show& show, const Names& names) {
  Json list = Json::array();
  const bool placed = !show.estimators.empty() && show.estimators.front().place;
  if (!placed && show.locks.empty()) return list;
  const IntervalBelief belief = placed ? *show.estimators.front().place : IntervalBelief{};
  for (std::size_t i = 0; i < names.intervals.size(); ++i) {
    list.push_back({{"id", names.intervals[i].id},
                    {"label", names.intervals[i].label()},
                    {"state", name(lockState(belief, i, show.locks))},
                    {"probability", placed ? number(probabilityOf(belief, i)) : Json(nullptr)}});
  }
  return list;
}

Json recordingJson(const std::optional<Recording>& recording) {
  if (!recording) return nullptr;
  return {{"on", recording->on},
          {"file", recording->file},
          {"measurements", recording->measurements},
          {"bytes", recording->bytes}};
}

}  // namespace

std::string stateBody(const Show& show, const Names& names) {
  Json json{{"mode", name(show.mode)},
            {"playing", show.playing},
            {"seeking", show.seeking},
            {"ended", show.ended},
            {"speed", show.speed},
            {"stamp_s", stampJson(show.stamp)},
            {"first_s", stampJson(show.first)},
            {"last_s", stampJson(show.last)},
            {"truth", show.truth ? poseJson(*show.truth) : Json(nullptr)},
            {"estimators", Json::array()}};
  const std::vector<Occupancy> by_place;
  for (const EstimatorState& state : show.estimators) {
    const bool first = &state == &show.estimators.front();
    json["estimators"].push_back(estimatorJson(state, show.stamp, names, first ? show.locks : by_place));
  }
  json["sources"] = sourcesJson(show.connections);
  json["anchors"] = anchorsJson(show.connections);
  json["locks"] = locksJson(show, names);
  json["recording"] = recordingJson(show.recording);
  json["refused_lines"] = show.refused_lines;
  return textOf(json);
}

std::string withSeq(std::uint64_t seq, const std::string& body) {
  return "{\"seq\":" + std::to_string(seq) + "," + body.substr(1);
}

}  // namespace pos::serve
