#pragma once
/// The part of a run's page that is about a longwall face. Internal to report.

#include <string>
#include <vector>

#include "pos/eval/face_geometry.hpp"

namespace pos::report {

/// Tables of cuts, stands and end operations; empty for a run without a face.
std::string faceSection(const std::vector<eval::EstimatorFace>& faces);

}  // namespace pos::report
