#include <algorithm>
#include <cmath>

#include "pos/eval/face_geometry.hpp"

namespace pos::eval {

std::map<std::string, std::optional<double>> faceMetrics(const FaceGeometry& face) {
  std::map<std::string, std::optional<double>> all;
  int number = 0;
  for (const FaceStand& stand : face.stands) {
    const std::string name = "face.stand_" + std::to_string(++number);
    constexpr const char* kAxes[] = {".lateral_error_m", ".station_error_m", ".height_error_m"};
    for (int i = 0; i < 3; ++i)
      all[name + kAxes[i]] = stand.error ? std::optional((*stand.error)[i]) : std::nullopt;
  }
  std::optional<double> worst;
  for (const EndOperation& operation : face.operations) {
    if (!operation.creep || !operation.truth) continue;
    const double error = *operation.creep - operation.truth->y();
    all["face.operation_" + std::to_string(operation.number) + ".creep_error_m"] = error;
    worst = std::max(worst.value_or(0.0), std::abs(error));
  }
  if (worst) all["face.creep_error_max_m"] = worst;
  for (const Cut& cut : face.cuts) {
    if (cut.bend_error) all["face.cut_" + std::to_string(cut.number) + ".bend_error_m"] = cut.bend_error;
  }
  return all;
}

}  // namespace pos::eval
