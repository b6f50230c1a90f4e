#include "pos/eval/face_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "face_parts.hpp"
#include "pos/eval/association.hpp"

namespace pos::eval {
namespace {

constexpr double kStandingTime = 3.0;  // s
constexpr double kStandingWay = 0.05;  // m in that time
constexpr double kLeft = 10.0;         // m from the end: the end operation has begun

/// Walks along the track and divides it into cuts and end operations.
class Walk {
 public:
  explicit Walk(FaceGeometry& face) : face_(face) {
    if (!face.track.empty() && station(0) > 0.5 * face.line.length) end_ = 1;
    begin(0);
  }

  void step(std::size_t i) {
    const double away = std::abs(station(i) - (end_ == 2 ? face_.line.length : 0.0));
    if (cutting_) {
      if (away < face_.line.end_zone && stands(i)) arrive(i);
      return;
    }
    left_ = left_ || away > kLeft;
    if (left_ && away < face_.line.end_zone && stands(i)) {
      addStand(i, true);
      end_ = 3 - end_;
      begin(i);
    }
  }

  void finish() {
    if (cutting_) face_.cuts.back().past = face_.track.size();
  }

 private:
  double station(std::size_t i) const { return face_.track[i].place.y(); }

  bool stands(std::size_t i) const {
    const Duration wanted = durationFromSeconds(kStandingTime);
    std::size_t before = i;
    while (before > 0 && face_.track[i].stamp - face_.track[before].stamp < wanted) --before;
    return face_.track[i].stamp - face_.track[before].stamp >= wanted &&
           std::abs(station(i) - station(before)) < kStandingWay;
  }

  void begin(std::size_t i) {
    cutting_ = true;
    left_ = false;
    const int number = static_cast<int>(face_.cuts.size()) + 1;
    face_.cuts.push_back({.number = number, .to_end = end_, .first = i, .past = i});
  }

  void arrive(std::size_t i) {
    cutting_ = false;
    face_.cuts.back().past = i + 1;
    face_.cuts.back().complete = true;
    addStand(i, false);
  }

  void addStand(std::size_t i, bool after) {
    const FacePoint& point = face_.track[i];
    FaceStand stand{.cut = static_cast<int>(face_.cuts.size()),
                    .end = end_,
                    .after = after,
                    .stamp = point.stamp,
                    .place = point.place};
    if (point.truth) stand.error = point.place - *point.truth;
    face_.stands.push_back(stand);
  }

  FaceGeometry& face_;
  int end_ = 2;
  bool cutting_ = true;
  bool left_ = false;
};

std::optional<NamedValue> valueOf(const Diagnostics& diagnostics, const std::string& name) {
  const auto found = std::find_if(diagnostics.begin(), diagnostics.end(),
                                  [&name](const NamedValue& value) { return value.name == name; });
  return found != diagnostics.end() ? std::optional(*found) : std::nullopt;
}

std::vector<EndOperation> operationsOf(const FaceGeometry& face, const Diagnostics& diagnostics) {
  std::vector<EndOperation> all;
  for (std::size_t i = 1; i < face.stands.size(); ++i) {
    const FaceStand& before = face.stands[i - 1];
    const FaceStand& after = face.stands[i];
    if (!after.after) continue;
    EndOperation operation{.number = after.cut, .end = after.end, .moved = after.place - before.place};
    if (before.error && after.error) operation.truth = operation.moved - (*after.error - *before.error);
    if (const auto creep = valueOf(diagnostics, "creep_" + std::to_string(after.cut) + "_m")) {
      operation.creep = creep->value;
      operation.creep_sigma = creep->sigma;
    }
    all.push_back(operation);
  }
  return all;
}

}  // namespace

Eigen::Vector3d onFace(const Eigen::Vector3d& p_map, const FaceLine& line) {
  const Eigen::Vector2d along(std::cos(line.heading), std::sin(line.heading));
  const Eigen::Vector2d right(along.y(), -along.x());
  const Eigen::Vector2d from_end_1 = p_map.head<2>() - line.end_1;
  return {right.dot(from_end_1), along.dot(from_end_1), p_map.z()};
}

FaceGeometry faceGeometry(const std::vector<Estimate>& estimates, const Truth* truth, const FaceLine& line,
                          const Diagnostics& diagnostics) {
  FaceGeometry face{.line = line};
  for (const Estimate& estimate : estimates) {
    if (!estimate.T_map_body.translation.allFinite()) continue;
    FacePoint point{.stamp = estimate.stamp, .place = onFace(estimate.T_map_body.translation, line)};
    const auto real = truth != nullptr
                          ? interpolate(*truth, estimate.stamp, AssociationOptions{}.max_truth_gap)
                          : std::nullopt;
    if (real) point.truth = onFace(real->translation, line);
    face.track.push_back(point);
  }
  if (face.track.empty()) return face;
  Walk walk(face);
  for (std::size_t i = 0; i < face.track.size(); ++i) walk.step(i);
  walk.finish();
  face.operations = operationsOf(face, diagnostics);
  for (Cut& cut : face.cuts) addProfile(face, cut);
  return face;
}

}  // namespace pos::eval
