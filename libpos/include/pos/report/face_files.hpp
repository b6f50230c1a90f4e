#pragma once
/// The face as tables and drawings: the shearer's track, the bend of every cut, what every end operation
/// moved. Columns: docs/formats/face.md.

#include <string>
#include <vector>

#include "pos/eval/face_geometry.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

/// One row per recorded place.
std::string faceTrackCsv(const eval::FaceGeometry& face);
/// One row per cut and metre.
std::string faceProfileCsv(const eval::FaceGeometry& face);
/// One row per end operation.
std::string faceOperationsCsv(const eval::FaceGeometry& face);

/// Track and bends of every estimator, and the creep of those that measure it.
std::vector<NamedFigure> faceFigures(const std::vector<eval::EstimatorFace>& faces);

}  // namespace pos::report
