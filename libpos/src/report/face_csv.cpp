#include "pos/report/face_files.hpp"
#include "pos/report/text.hpp"

namespace pos::report {
namespace {

std::string metres(double value) {
  return fixed(value, 4);
}

std::string cell(const std::optional<double>& value) {
  return "," + (value ? metres(*value) : std::string());
}

/// Three cells, empty where there is nothing.
std::string cells(const std::optional<Eigen::Vector3d>& v) {
  if (!v) return ",,,";
  return "," + metres(v->x()) + "," + metres(v->y()) + "," + metres(v->z());
}

}  // namespace

std::string faceTrackCsv(const eval::FaceGeometry& face) {
  std::string csv =
      "stamp_s,cycle,doing,lateral_m,station_m,height_m,true_lateral_m,true_station_m,true_height_m\n";
  auto cut = face.cuts.begin();
  for (std::size_t i = 0; i < face.track.size(); ++i) {
    while (cut != face.cuts.end() && std::next(cut) != face.cuts.end() && std::next(cut)->first <= i) ++cut;
    if (cut == face.cuts.end()) break;
    const eval::FacePoint& point = face.track[i];
    csv += fixed(secondsSinceOrigin(point.stamp), 3) + "," + std::to_string(cut->number) +
           (i < cut->past ? ",cut" : ",end") + cells(point.place) + cells(point.truth) + "\n";
  }
  return csv;
}

std::string faceProfileCsv(const eval::FaceGeometry& face) {
  std::string csv = "cycle,to_end,station_m,bend_m,floor_m,true_bend_m,true_floor_m\n";
  for (const eval::Cut& cut : face.cuts) {
    for (const eval::ProfilePoint& point : cut.profile) {
      csv += std::to_string(cut.number) + "," + std::to_string(cut.to_end) + "," + fixed(point.station, 1) +
             cell(point.bend) + cell(point.floor) + cell(point.true_bend) + cell(point.true_floor) + "\n";
    }
  }
  return csv;
}

std::string faceOperationsCsv(const eval::FaceGeometry& face) {
  std::string csv =
      "operation,end,creep_m,creep_sigma_m,advance_m,along_m,up_m,true_advance_m,true_along_m,true_up_m\n";
  for (const eval::EndOperation& operation : face.operations) {
    csv += std::to_string(operation.number) + "," + std::to_string(operation.end) + cell(operation.creep) +
           cell(operation.creep ? std::optional(operation.creep_sigma) : std::nullopt) +
           cells(operation.moved) + cells(operation.truth) + "\n";
  }
  return csv;
}

}  // namespace pos::report
