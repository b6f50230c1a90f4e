#include "pos/eval/face_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "pos/core/angle.hpp"

namespace pos::eval {
namespace {

const Stamp kStart = stampFromSeconds(1000.0);
constexpr double kLength = 60.0;
constexpr double kWave = 0.08;  // m, amplitude of the bend

/// A shearer on a face of 60 m along +y, one estimate a second: to end 2, out 20 m and back on a line 1 m
/// further and `creep` along, to end 1. It stands 10 s at every reversal.
struct Ride {
  Truth truth = {};
  double t = 0.0;

  void at(const Eigen::Vector3d& p) {
    truth.poses.push_back({kStart + durationFromSeconds(t), Pose3{p, Eigen::Quaterniond::Identity()}});
    t += 1.0;
  }
  static Eigen::Vector3d line(int cut, double station, double creep) {
    const double bend = kWave * std::sin(2.0 * kPi * station / 30.0);
    return {static_cast<double>(cut) + bend, station + cut * creep, 0.0};
  }
  void drive(double from, double to, const std::function<Eigen::Vector3d(double)>& place) {
    const double step = to > from ? 0.1 : -0.1;
    const int count = static_cast<int>(std::lround((to - from) / step));
    for (int i = 0; i <= count; ++i) at(place(from + i * step));
    for (int i = 0; i < 10; ++i) at(place(to));
  }
};

Truth ride(double creep) {
  Ride ride;
  const auto old_line = [&](double s) { return Ride::line(0, s, creep); };
  const auto new_line = [&](double s) { return Ride::line(1, s, creep); };
  ride.drive(0.0, kLength, old_line);
  ride.drive(kLength, kLength - 20.0, old_line);
  ride.drive(kLength - 20.0, kLength, new_line);
  ride.drive(kLength, 0.0, new_line);
  return ride.truth;
}

std::vector<Estimate> estimatesOf(const Truth& truth,
                                  const std::function<Eigen::Vector3d(std::size_t)>& error) {
  std::vector<Estimate> estimates;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    Estimate estimate{.stamp = truth.poses[i].stamp, .T_map_body = truth.poses[i].T_map_body};
    estimate.T_map_body.translation += error(i);
    estimates.push_back(estimate);
  }
  return estimates;
}

const FaceLine kFace{.length = kLength};
const auto kNoError = [](std::size_t) { return Eigen::Vector3d(0.0, 0.0, 0.0); };

}  // namespace

TEST(FaceGeometry, AxesAreThoseOfTheFace) {
  const FaceLine line{.end_1 = {10.0, 20.0}, .heading = 0.0};  // along +x: right is -y
  EXPECT_LT((onFace({13.0, 18.0, 5.0}, line) - Eigen::Vector3d(2.0, 3.0, 5.0)).norm(), 1e-12);
}

TEST(FaceGeometry, DividesTheTrackIntoCutsStandsAndEndOperations) {
  const Truth truth = ride(-0.2);
  const FaceGeometry face = faceGeometry(estimatesOf(truth, kNoError), &truth, kFace);
  ASSERT_EQ(face.cuts.size(), 2U);
  EXPECT_EQ(face.cuts[0].to_end, 2);
  EXPECT_EQ(face.cuts[1].to_end, 1);
  EXPECT_TRUE(face.cuts[0].complete && face.cuts[1].complete);
  ASSERT_EQ(face.stands.size(), 3U);
  EXPECT_FALSE(face.stands[0].after);
  EXPECT_TRUE(face.stands[1].after);
  EXPECT_EQ(face.stands[1].end, 2);
  EXPECT_EQ(face.stands[2].end, 1);
  ASSERT_EQ(face.operations.size(), 1U);
  EXPECT_NEAR(face.operations[0].moved.x(), 1.0, 1e-9);
  EXPECT_NEAR(face.operations[0].moved.y(), -0.2, 1e-9);
  EXPECT_NEAR(face.operations[0].truth.value().y(), -0.2, 1e-9);
  EXPECT_FALSE(face.operations[0].creep);
}

TEST(FaceGeometry, BendIsWhatStraysFromTheBestLine) {
  const Truth truth = ride(0.0);
  // A yaw error turns a straight cut, and does not bend it.
  const auto estimates = estimatesOf(truth, [&](std::size_t i) {
    return Eigen::Vector3d(1e-3 * truth.poses[i].T_map_body.translation.y(), 0.0, 0.0);
  });
  const FaceGeometry face = faceGeometry(estimates, &truth, kFace);
  ASSERT_EQ(face.cuts.size(), 2U);
  for (const Cut& cut : face.cuts) {
    ASSERT_FALSE(cut.profile.empty());
    EXPECT_NEAR(cut.profile.back().station - cut.profile.front().station, kLength, 1.01);
    // Two whole waves: the line through them is a little askew, 3 / (pi n) of the amplitude per half length
    // at most.
    EXPECT_NEAR(cut.bend_range, 2.0 * kWave, 0.5 * kWave);
    EXPECT_NEAR(cut.bend_error.value(), 0.0, 1e-4);
    EXPECT_NEAR(cut.true_bend_range.value(), cut.bend_range, 1e-4);
  }
}

TEST(FaceGeometry, ErrorsAtTheStandsAreSigned) {
  const Truth truth = ride(0.0);
  const auto estimates = estimatesOf(truth, [](std::size_t) { return Eigen::Vector3d(-0.2, 0.1, 0.05); });
  const FaceGeometry face = faceGeometry(estimates, &truth, kFace);
  ASSERT_EQ(face.stands.size(), 3U);
  for (const FaceStand& stand : face.stands)
    EXPECT_LT((stand.error.value() - Eigen::Vector3d(-0.2, 0.1, 0.05)).norm(), 1e-9);
  EXPECT_FALSE(faceGeometry(estimates, nullptr, kFace).stands[0].error);
}

TEST(FaceGeometry, CreepIsThatOfTheDiagnostics) {
  const Truth truth = ride(-0.2);
  const FaceGeometry face = faceGeometry(estimatesOf(truth, kNoError), &truth, kFace,
                                         {{"creep_1_m", -0.197, 0.002}, {"creep_2_m", 9.0}});
  ASSERT_EQ(face.operations.size(), 1U);
  EXPECT_EQ(face.operations[0].creep, -0.197);
  EXPECT_EQ(face.operations[0].creep_sigma, 0.002);
  const auto figures = faceMetrics(face);
  EXPECT_NEAR(figures.at("face.operation_1.creep_error_m").value(), 0.003, 1e-9);
  EXPECT_NEAR(figures.at("face.stand_2.station_error_m").value(), 0.0, 1e-9);
}

TEST(FaceGeometry, APartOfACutIsShownAsSuch) {
  const Truth truth = ride(0.0);
  std::vector<Estimate> estimates = estimatesOf(truth, kNoError);
  estimates.resize(300);  // 30 m
  const FaceGeometry face = faceGeometry(estimates, &truth, kFace);
  ASSERT_EQ(face.cuts.size(), 1U);
  EXPECT_FALSE(face.cuts[0].complete);
  EXPECT_EQ(face.cuts[0].past, 300U);
  EXPECT_TRUE(face.stands.empty());
  EXPECT_TRUE(faceGeometry({}, &truth, kFace).cuts.empty());
}

}  // namespace pos::eval
