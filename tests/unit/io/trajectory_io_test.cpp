#include "pos/io/trajectory_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Any pose with |pitch| < 80 deg, and a positive definite covariance.
Estimate randomEstimate(RandomStream& random, std::int64_t ns) {
  Estimate estimate;
  estimate.stamp = Stamp{Duration{ns}};
  estimate.T_map_body = Pose3::fromXyzYawPitchRoll(random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4),
                                                   random.uniform(-100, 100), random.uniform(-3.1, 3.1),
                                                   random.uniform(-1.4, 1.4), random.uniform(-3.1, 3.1));
  Matrix<6, 6> root;
  for (double& value : root.reshaped()) value = random.normal(0.0, 0.3);
  estimate.covariance = root * root.transpose();
  return estimate;
}

std::vector<Estimate> randomEstimates(std::size_t count) {
  RandomStream random(5, 0);
  std::vector<Estimate> estimates;
  for (std::size_t i = 0; i < count; ++i) {
    const auto step = static_cast<std::int64_t>(i) * 123456789;
    estimates.push_back(randomEstimate(random, 1600000000987654321 + step));
  }
  return estimates;
}

void expectSamePose(const Estimate& read, const Estimate& written) {
  EXPECT_EQ(read.stamp, written.stamp);
  EXPECT_LT(minus(read.T_map_body, written.T_map_body).cwiseAbs().maxCoeff(), 2e-9);
  EXPECT_LT((read.T_map_body.translation - written.T_map_body.translation).cwiseAbs().maxCoeff(), 1e-9);
}

template <class Writer>
void writeAll(const std::filesystem::path& path, const std::vector<Estimate>& estimates) {
  Writer writer(path);
  for (const Estimate& estimate : estimates) writer.write(estimate);
  writer.close();
}

TEST(TrajectoryIo, TumReadsBack) {
  const ScratchFolder folder;
  const auto estimates = randomEstimates(200);
  writeAll<TumWriter>(folder.path() / "a.tum", estimates);
  const auto read = readTum(folder.path() / "a.tum");
  ASSERT_EQ(read.size(), estimates.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    expectSamePose(read[i], estimates[i]);
    EXPECT_TRUE(read[i].covariance.isZero());
  }
  EXPECT_EQ(readTumTruth(folder.path() / "a.tum").poses.size(), estimates.size());
}

TEST(TrajectoryIo, TumBytesAreAsDocumented) {
  const ScratchFolder folder;
  Estimate estimate{stampFromSeconds(1.5), Pose3::fromXyzYawPitchRoll(1, -2, -0.0, -0.5 * kPi, 0, 0)};
  estimate.T_map_body.rotation.coeffs() *= -1.0;  // the same rotation
  writeAll<TumWriter>(folder.path() / "a.tum", {estimate});
  EXPECT_EQ(
      folder.read("a.tum"),
      "# t x y z qx qy qz qw\n1.500000000 1.000000000 -2.000000000 0.000000000 0.000000000000 0.000000000000 "
      "-0.707106781187 0.707106781187\n");
}

TEST(TrajectoryIo, CovarianceHasOrientationFirst) {
  const ScratchFolder folder;
  Estimate estimate{stampFromSeconds(0.0), {}};
  for (int i = 0; i < 6; ++i) estimate.covariance(i, i) = i + 1;
  estimate.covariance(0, 1) = estimate.covariance(1, 0) = 0.5;
  estimate.covariance(3, 5) = estimate.covariance(5, 3) = 0.25;
  writeAll<TumCovarianceWriter>(folder.path() / "a.tum", {estimate});
  EXPECT_THAT(folder.read("a.tum"), HasSubstr(" 4 0 0.25 5 0 6 1 0.5 0 2 0 3\n"));
}

TEST(TrajectoryIo, CovarianceReadsBackBlockwiseExactly) {
  const ScratchFolder folder;
  const auto estimates = randomEstimates(100);
  writeAll<TumCovarianceWriter>(folder.path() / "a.tum", estimates);
  const auto read = readTum(folder.path() / "a.tum");
  ASSERT_EQ(read.size(), estimates.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    expectSamePose(read[i], estimates[i]);
    const auto& P = estimates[i].covariance;
    EXPECT_LT((read[i].covariance.topLeftCorner<3, 3>() - P.topLeftCorner<3, 3>()).norm(), 1e-15);
    EXPECT_LT((read[i].covariance.bottomRightCorner<3, 3>() - P.bottomRightCorner<3, 3>()).norm(), 1e-15);
    EXPECT_TRUE((read[i].covariance.topRightCorner<3, 3>().isZero()));
  }
}

TEST(TrajectoryIo, EstimateTableReadsBackWithItsPlanarCovariance) {
  const ScratchFolder folder;
  const auto estimates = randomEstimates(100);
  EstimateCsvWriter writer(folder.path() / "a.csv");
  for (const Estimate& estimate : estimates) writer.write(estimate, {});
  writer.close();
  const auto read = readEstimateCsv(folder.path() / "a.csv");
  ASSERT_EQ(read.size(), estimates.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    expectSamePose(read[i], estimates[i]);
    EXPECT_LT((read[i].planarCovariance() - estimates[i].planarCovariance()).norm(), 1e-9);
    EXPECT_LT((read[i].covariance.diagonal() - estimates[i].covariance.diagonal()).norm(), 1e-9);
  }
}

TEST(TrajectoryIo, EstimateTableBytesAreAsDocumented) {
  const ScratchFolder folder;
  const Matrix<3, 3> P = (Matrix<3, 3>() << 4, 3, 0, 3, 9, 0, 0, 0, 0).finished();
  EstimateCsvWriter writer(folder.path() / "a.csv");
  writer.write(planarEstimate(stampFromSeconds(2.25), {1, 2, 0.5 * kPi}, P, 0.5), {5, 4, 3, 2, 1, 0});
  writer.close();
  EXPECT_EQ(
      folder.read("a.csv"),
      "stamp_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg,sigma_x_m,sigma_y_m,sigma_z_m,sigma_yaw_deg,sigma_"
      "pitch_"
      "deg,sigma_roll_deg,corr_x_y,corr_x_yaw,corr_y_yaw,applied,gated,too_old,unsupported,degenerate,not_"
      "initialised,v_forward_m_per_s,v_left_m_per_s,yaw_rate_deg_per_s,"
      "sigma_v_forward_m_per_s,sigma_v_left_m_per_s,sigma_yaw_rate_deg_per_s\n"
      "2.250000000,1.000000000,2.000000000,0.500000000,90.0000000000,0.0000000000,0.0000000000,2,3,0,0,0,0,0."
      "5,"
      "0,0,5,4,3,2,1,0,,,,,,\n");
}

TEST(EstimateCsv, VelocityStandsInTheLastColumnsWhereItIsKnown) {
  const ScratchFolder folder;
  Estimate estimate = planarEstimate(stampFromSeconds(1.0), {}, Matrix<3, 3>::Identity());
  estimate.twist = PlanarTwist{Vector<3>(0.5, -0.25, kPi), Vector<3>(4.0, 9.0, 0.0).asDiagonal()};
  EstimateCsvWriter writer(folder.path() / "a.csv");
  writer.write(estimate, {});
  writer.close();
  const std::string text = folder.read("a.csv");
  EXPECT_TRUE(text.ends_with(",0.5,-0.25,180,2,3,0\n")) << text;
}

TEST(TrajectoryIo, StraightUpStillReadsBack) {
  const ScratchFolder folder;
  const Estimate estimate{stampFromSeconds(0), Pose3::fromXyzYawPitchRoll(0, 0, 0, 1.0, 0.5 * kPi, 0.25)};
  EstimateCsvWriter writer(folder.path() / "a.csv");
  writer.write(estimate, {});
  writer.close();
  const auto read = readEstimateCsv(folder.path() / "a.csv");
  EXPECT_LT(minus(read.at(0).T_map_body, estimate.T_map_body).norm(), 1e-8);
}

TEST(TrajectoryIo, BytesDoNotDependOnTheLocale) {
  const ScratchFolder folder;
  const auto estimates = randomEstimates(5);
  writeAll<TumCovarianceWriter>(folder.path() / "a.tum", estimates);
  for (const char* name : {"de_DE.UTF-8", "C.UTF-8"}) std::setlocale(LC_ALL, name);
  writeAll<TumCovarianceWriter>(folder.path() / "b.tum", estimates);
  EXPECT_EQ(readTum(folder.path() / "b.tum").size(), 5U);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(folder.read("a.tum"), folder.read("b.tum"));
}

TEST(TrajectoryIo, EurocHasNanosecondsAndWFirst) {
  const ScratchFolder folder;
  const auto path =
      folder.write("gt.csv",
                   "#timestamp, p_RS_R_x [m], ...\n1403636580838555648,4.688319,-1.786938,0.783338,"
                   "0.5,-0.5,0.5,-0.5,-0.02,0.03,0.01,0,0,0,0,0,0\r\n"
                   "1403636580843555328, 4.7, -1.7, 0.8, 1, 0, 0, 0\n");
  const Truth truth = readEurocTruth(path);
  ASSERT_EQ(truth.poses.size(), 2U);
  EXPECT_EQ(truth.poses[0].stamp.time_since_epoch().count(), 1403636580838555648);
  EXPECT_EQ(truth.poses[0].T_map_body.translation, Eigen::Vector3d(4.688319, -1.786938, 0.783338));
  EXPECT_EQ(truth.poses[0].T_map_body.rotation.w(), 0.5);
  EXPECT_EQ(truth.poses[0].T_map_body.rotation.x(), -0.5);
  EXPECT_EQ(truth.poses[0].T_map_body.rotation.z(), -0.5);
  EXPECT_EQ(truth.poses[1].T_map_body.rotation.w(), 1.0);
}

TEST(TrajectoryIo, IndexTruthTakesTheStampsOfTheFrames) {
  const ScratchFolder folder;
  const auto path = folder.write("gt.txt", "0 0.0 0.0 0.0\r\n1 1.0 0.5 1.570796326794897\r\n");
  const std::vector<Stamp> stamps{stampFromSeconds(10), stampFromSeconds(11)};
  const Truth truth = readIndexTruth(path, {stamps}, {2.0, 4.0, 0.0});
  ASSERT_EQ(truth.poses.size(), 2U);
  EXPECT_EQ(truth.poses[1].stamp, stamps[1]);
  EXPECT_EQ(truth.poses[1].T_map_body.translation, Eigen::Vector3d(3.0, 4.5, 0.0));
  EXPECT_NEAR(truth.poses[1].T_map_body.yaw(), 0.5 * kPi, 1e-12);
  EXPECT_TRUE(truth.has_yaw && !truth.has_z);
}

TEST(TrajectoryIo, IndexTruthOfADamagedLogEndsWithItsFrames) {
  const ScratchFolder folder;
  const auto path = folder.write("gt.txt", "0 0 0 0\n1 1 0 0\n2 2 0 0\n");
  const FrameStamps frames{{Stamp{}, stampFromSeconds(1)}, false};
  const Truth truth = readIndexTruth(path, frames);
  ASSERT_EQ(truth.poses.size(), 2U);
  EXPECT_EQ(truth.poses[1].stamp, frames.stamps[1]);
}

TEST(TrajectoryIo, IndexTruthMustMatchTheFrames) {
  const ScratchFolder folder;
  const auto path = folder.write("gt.txt", "0 0 0 0\n1 1 0 0\n");
  const auto read = [&](std::vector<Stamp> stamps) {
    return complaintOf<DataError>([&] { readIndexTruth(path, {std::move(stamps)}); });
  };
  EXPECT_THAT(read({Stamp{}}), AllOf(HasSubstr("gt.txt:2"), HasSubstr("more truth rows")));
  EXPECT_THAT(read({Stamp{}, stampFromSeconds(1), stampFromSeconds(2)}), HasSubstr("fewer truth rows"));
  EXPECT_THAT(read({Stamp{}, Stamp{}}), HasSubstr("do not increase"));
  const auto gap = folder.write("gap.txt", "0 0 0 0\n2 1 0 0\n");
  EXPECT_THAT(complaintOf<DataError>([&] {
                readIndexTruth(gap, {{Stamp{}, stampFromSeconds(1)}});
              }),
              HasSubstr("gap.txt:2:1: the index does not count up"));
}

struct BadTum {
  const char* text;
  const char* complaint;
};

TEST(TrajectoryIo, BadTumRowsNameTheirLine) {
  const ScratchFolder folder;
  const BadTum cases[]{
      {"# c\n0 0 0 0 0 0 0\n", "a.tum:2:1: the row has the wrong length"},
      {"0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n", "a.tum:2:3: the value is not a finite number"},
      {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 0\n", "a.tum:2:9: the quaternion does not have length 1"},
      {"x 0 0 0 0 0 0 1\n", "a.tum:1:1: the stamp is not a time"},
      {"1 0 0 0 0 0 0 1\n0.5 0 0 0 0 0 0 1\n", "a.tum:2:1: the"},
      {"1,0,0,0,0,0,0,1\n", "a.tum:1:1: the row has the wrong length"},
  };
  for (const BadTum& bad : cases) {
    const auto path = folder.write("a.tum", bad.text);
    EXPECT_THAT(complaintOf<DataError>([&] { readTumTruth(path); }), HasSubstr(bad.complaint));
    EXPECT_THAT(complaintOf<DataError>([&] { readTum(path); }),
                AnyOf(HasSubstr(bad.complaint), HasSubstr("stamps go back")));
  }
}

TEST(TrajectoryIo, EqualStampsAreLegalForEstimatesOnly) {
  const ScratchFolder folder;
  const auto path = folder.write("a.tum", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(readTum(path).size(), 2U);
  EXPECT_THAT(complaintOf<DataError>([&] { readTumTruth(path); }), HasSubstr("a.tum:2:1"));
}

TEST(TrajectoryIo, RowsOfMixedLengthAreRefused) {
  const ScratchFolder folder;
  const auto path = folder.write("a.tum", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1 1 0 0 1 0 1 1 0 0 1 0 1\n");
  EXPECT_THAT(complaintOf<DataError>([&] { readTum(path); }),
              AllOf(HasSubstr("a.tum:2"), HasSubstr("20 values"), HasSubstr("8 values as above")));
}

TEST(TrajectoryIo, EmptyTruthIsRefused) {
  const ScratchFolder folder;
  EXPECT_THAT(complaintOf<DataError>([&] { readTumTruth(folder.write("a.tum", "# nothing\n")); }),
              HasSubstr("holds no pose"));
  EXPECT_THAT(complaintOf<DataError>([&] { readEurocTruth(folder.path() / "no.csv"); }), HasSubstr("no.csv"));
}

TEST(TrajectoryIo, BadEstimateTableIsRefused) {
  const ScratchFolder folder;
  EstimateCsvWriter writer(folder.path() / "a.csv");
  writer.write(Estimate{stampFromSeconds(1), {}}, {});
  writer.close();
  const std::string good = folder.read("a.csv");
  const std::string row = good.substr(good.find('\n') + 1);
  const auto complaint = [&](const std::string& text) {
    return complaintOf<DataError>([&] { readEstimateCsv(folder.write("b.csv", text)); });
  };
  EXPECT_THAT(complaint(good + "0" + row.substr(1)), AllOf(HasSubstr("b.csv:3:1"), HasSubstr("go back")));
  EXPECT_THAT(complaint(good + "nan" + row.substr(1)), HasSubstr("b.csv:3:1"));
  EXPECT_THAT(complaint("stamp_s,x_m\n0,0\n"), HasSubstr("no column 'y_m'"));
}

TEST(TrajectoryIo, WritingWhereNothingCanBeWrittenIsRefused) {
  const ScratchFolder folder;
  EXPECT_THAT(complaintOf<DataError>([&] { TumWriter writer(folder.path() / "no" / "a.tum"); }),
              HasSubstr("cannot write"));
}

TEST(TrajectoryIo, AnEstimateThatIsNotFiniteIsABug) {
  const ScratchFolder folder;
  TumWriter writer(folder.path() / "a.tum");
  Estimate estimate;
  estimate.T_map_body.translation.x() = std::nan("");
  EXPECT_THROW(writer.write(estimate), ContractError);
}

TEST(TrajectoryIo, TruthIsWrittenAsTum) {
  const ScratchFolder folder;
  Truth truth;
  truth.poses.push_back({stampFromSeconds(1), Pose3::fromPlanar({1, 2, 3})});
  writeTum(folder.path() / "a.tum", truth);
  EXPECT_NEAR(readTumTruth(folder.path() / "a.tum").poses.at(0).T_map_body.yaw(), 3.0, 1e-9);
}

}  // namespace
}  // namespace pos::io
