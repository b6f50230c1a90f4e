// How straight a cut is: what it strays from the line that fits it best.
#include <algorithm>
#include <cmath>

#include "face_parts.hpp"

namespace pos::eval {
namespace {

constexpr double kStep = 1.0;       // m between two points of a profile
constexpr double kShortest = 10.0;  // m of way: less than that has no shape

/// (lateral, height) by station, read off a track that may go to and fro a little.
struct Curve {
  std::vector<double> station;
  std::vector<Eigen::Vector2d> value;

  /// Points whose station goes on upwards; what backs is left out.
  static Curve of(std::vector<Eigen::Vector3d> places, int to_end) {
    if (to_end == 1) std::reverse(places.begin(), places.end());
    Curve curve;
    for (const Eigen::Vector3d& p : places) {
      if (!curve.station.empty() && p.y() <= curve.station.back()) continue;
      curve.station.push_back(p.y());
      curve.value.emplace_back(p.x(), p.z());
    }
    return curve;
  }

  bool empty() const { return station.size() < 2 || station.back() - station.front() < kShortest; }

  std::optional<Eigen::Vector2d> at(double s) const {
    const auto after = std::lower_bound(station.begin(), station.end(), s);
    if (after == station.end() || (after == station.begin() && *after > s)) return std::nullopt;
    const auto i = static_cast<std::size_t>(after - station.begin());
    if (i == 0) return value.front();
    const double share = (s - station[i - 1]) / (station[i] - station[i - 1]);
    return value[i - 1] + share * (value[i] - value[i - 1]);
  }

  /// Every metre, at whole metres, off the straight line that fits them best.
  std::vector<std::pair<double, Eigen::Vector2d>> straightened() const {
    std::vector<std::pair<double, Eigen::Vector2d>> points;
    for (double s = kStep * std::ceil(station.front() / kStep); s <= station.back(); s += kStep) {
      if (const auto v = at(s)) points.emplace_back(s, *v);
    }
    const auto n = static_cast<double>(points.size());
    double mean_s = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& [s, v] : points) {
      mean_s += s / n;
      mean += v / n;
    }
    double spread = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (const auto& [s, v] : points) {
      spread += (s - mean_s) * (s - mean_s);
      slope += (s - mean_s) * (v - mean);
    }
    slope /= spread;
    for (auto& [s, v] : points) v -= mean + (s - mean_s) * slope;
    return points;
  }
};

double rangeOf(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() ? 0.0 : *high - *low;
}

void addTruth(const Curve& truth, Cut& cut) {
  std::vector<double> bends;
  double squares = 0.0;
  const auto straight = truth.straightened();
  auto next = straight.begin();
  for (ProfilePoint& point : cut.profile) {
    next = std::find_if(next, straight.end(),
                        [&point](const auto& each) { return each.first >= point.station - 0.5 * kStep; });
    if (next == straight.end()) break;
    if (std::abs(next->first - point.station) > 0.5 * kStep) continue;
    point.true_bend = next->second.x();
    point.true_floor = next->second.y();
    bends.push_back(next->second.x());
    squares += (point.bend - *point.true_bend) * (point.bend - *point.true_bend);
  }
  if (bends.empty()) return;
  cut.true_bend_range = rangeOf(bends);
  cut.bend_error = std::sqrt(squares / static_cast<double>(bends.size()));
}

}  // namespace

void addProfile(const FaceGeometry& face, Cut& cut) {
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector3d> truths;
  for (std::size_t i = cut.first; i < cut.past; ++i) {
    places.push_back(face.track[i].place);
    if (face.track[i].truth) truths.push_back(*face.track[i].truth);
  }
  const Curve curve = Curve::of(places, cut.to_end);
  if (curve.empty()) return;
  std::vector<double> bends;
  for (const auto& [s, off] : curve.straightened()) {
    cut.profile.push_back({.station = s, .bend = off.x(), .floor = off.y()});
    bends.push_back(off.x());
  }
  cut.bend_range = rangeOf(bends);
  const Curve truth = Curve::of(truths, cut.to_end);
  if (!truth.empty()) addTruth(truth, cut);
}

}  // namespace pos::eval
