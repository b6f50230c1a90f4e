#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/report/face_files.hpp"
#include "pos/report/figures.hpp"
#include "pos/report/html.hpp"
#include "unit/report/demo_run.hpp"

namespace pos::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

eval::FaceGeometry face() {
  eval::FaceGeometry face;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d place(0.01 * i, i, 0.0);
    face.track.push_back({stampFromSeconds(10.0 + i), place, place + Eigen::Vector3d(0.1, 0.0, 0.0)});
  }
  face.cuts.push_back({.number = 1, .complete = true, .first = 0, .past = 3});
  face.cuts[0].profile = {{0.0, 0.01, 0.0, 0.02, 0.0}, {1.0, -0.01, 0.0, {}, {}}};
  face.cuts[0].bend_range = 0.02;
  face.stands.push_back({.stamp = stampFromSeconds(12.0), .error = Eigen::Vector3d(-0.1, 0.0, 0.0)});
  face.operations.push_back({.moved = {1.0, -0.17, 0.0}, .creep = -0.176, .creep_sigma = 0.002});
  return face;
}

}  // namespace

TEST(FaceTables, HaveARowForEveryPlaceMetreAndOperation) {
  const std::string track = faceTrackCsv(face());
  EXPECT_THAT(track, HasSubstr("12.000,1,cut,0.0200,2.0000,0.0000,0.1200,2.0000,0.0000\n"));
  EXPECT_THAT(track, HasSubstr("13.000,1,end,"));
  EXPECT_THAT(faceProfileCsv(face()),
              HasSubstr("1,2,0.0,0.0100,0.0000,0.0200,0.0000\n1,2,1.0,-0.0100,0.0000,,\n"));
  EXPECT_THAT(faceOperationsCsv(face()), HasSubstr("1,2,-0.1760,0.0020,1.0000,-0.1700,0.0000,,,\n"));
}

TEST(FaceReport, ShowsTrackBendAndCreepOfAShearerOnly) {
  const eval::RunSummary run = demoRun();
  EXPECT_THAT(reportHtml(run, ""), Not(HasSubstr("id=\"face\"")));
  const std::vector<eval::EstimatorFace> faces{{"proposed", face()}};
  std::vector<std::string> names;
  for (const NamedFigure& figure : faceFigures(faces)) names.push_back(figure.name);
  EXPECT_THAT(names, ::testing::ElementsAre("face_track_1", "face_bend_1", "creep"));
  const std::string html = reportHtml(
      run, "", {.faces = faces, .pictures = {{"legs_x", "Sweep", "How to read it", "<svg>legs</svg>"}}});
  EXPECT_THAT(html, HasSubstr("id=\"face\""));
  EXPECT_THAT(html, HasSubstr("-0.1760"));
  EXPECT_THAT(html, HasSubstr("<svg>legs</svg>"));
}

}  // namespace pos::report
