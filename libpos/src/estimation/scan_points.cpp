#include "pos/estimation/scan_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace pos::estimation {
namespace {

std::vector<std::size_t> chosenBeams(const Scan2D& scan, int wanted) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const bool returned = scan.valid[i] != 0 && scan.ranges[i] > 0.0F;
    if (returned && (scan.range_max <= 0.0 || static_cast<double>(scan.ranges[i]) < scan.range_max)) {
      usable.push_back(i);
    }
  }
  const auto count = static_cast<std::size_t>(wanted);
  if (usable.size() <= count) return usable;
  std::vector<std::size_t> chosen(count);
  for (std::size_t k = 0; k < count; ++k) chosen[k] = usable[(2 * k + 1) * usable.size() / (2 * count)];
  return chosen;
}

void shareWeights(lidar::BeamPoints& points, double side) {
  const auto square = [&](std::size_t b) {
    return std::pair(std::lround(std::floor(static_cast<double>(points.x[b]) / side)),
                     std::lround(std::floor(static_cast<double>(points.y[b]) / side)));
  };
  std::map<std::pair<long, long>, int> crowd;
  for (std::size_t b = 0; b < points.size(); ++b) ++crowd[square(b)];
  for (std::size_t b = 0; b < points.size(); ++b) points.weight[b] /= static_cast<float>(crowd[square(b)]);
}

}  // namespace

lidar::BeamPoints beamPoints(const Scan2D& scan, const ScanLikelihood& config) {
  lidar::BeamPoints points;
  for (const std::size_t i : chosenBeams(scan, config.beams)) {
    const double angle = scan.angle_first + static_cast<double>(i) * scan.angle_step;
    const double range = scan.ranges[i];
    const Eigen::Vector3d p_body =
        scan.T_body_sensor * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.0);
    points.x.push_back(static_cast<float>(p_body.x()));
    points.y.push_back(static_cast<float>(p_body.y()));
    points.weight.push_back(static_cast<float>(config.tempering));
  }
  if (config.correlation_length > 0.0) shareWeights(points, config.correlation_length);
  return points;
}

}  // namespace pos::estimation
