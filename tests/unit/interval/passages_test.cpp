#include "pos/interval/passages.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "pos/interval/road_aid.hpp"
#include "support/interval_drive.hpp"

namespace pos::interval {
namespace {

class PassagesTest : public ::testing::Test {
 protected:
  Estimate at(double t, double x, double sigma) const {
    const Matrix<3, 3> P = Vector<3>(sigma * sigma, 0.25, 1e-4).asDiagonal();
    return planarEstimate(stampFromSeconds(t), {x, -1.0, 0.0}, P);
  }
  /// Drives east to x at 5 m/s.
  void driveTo(double x, double sigma = 0.5) {
    for (; x_ <= x; x_ += 0.5) {
      road.take(at(x_ / 5.0, x_, sigma));
      for (const std::string& id : passages.missed(road)) missed.push_back(id);
    }
  }
  Passage see(const std::string& chamber, const Eigen::Vector3d& reader = Eigen::Vector3d::Zero()) {
    return passages.judged({stampFromSeconds(x_ / 5.0), chamber, reader}, road);
  }

  testing::IntervalDrive scene{testing::intervalDemo()};
  RoadTracker road{scene.network, scene.graph, {}};
  PassageCheck passages{scene.network, {}};
  std::vector<std::string> missed;
  double x_ = 10.0;
};

}  // namespace

TEST_F(PassagesTest, ARightSightingBecomesAFixWithItsCovarianceInTheRoadsDirections) {
  driveTo(150.5);
  const Passage passage = see("R150");
  ASSERT_EQ(passage.verdict, PassageVerdict::Accepted);
  const auto& fix = std::get<PassageFix>(passage.fix->reading);
  EXPECT_FALSE(defect(*passage.fix));
  EXPECT_EQ(fix.place, "R150");
  EXPECT_NEAR(fix.p_map.x(), 150.0, 1e-9);
  EXPECT_NEAR(std::sqrt(fix.covariance(0, 0)), 0.3 + 5.0 * 0.05, 0.01);  // sigma_c + v sigma_t
  EXPECT_NEAR(std::sqrt(fix.covariance(1, 1)), testing::kMainWidth / std::sqrt(12.0), 1e-9);
}

TEST_F(PassagesTest, AReaderAheadOfTheBodyIsThereBeforeIt) {
  driveTo(144.0, 0.1);
  const Eigen::Vector3d reader(6.0, 0.0, 2.0);
  EXPECT_EQ(see("R150").verdict, PassageVerdict::OutOfReach);
  const Passage passage = see("R150", reader);
  ASSERT_EQ(passage.verdict, PassageVerdict::Accepted);
  EXPECT_NEAR(passage.off, 0.0, 1e-9);
  EXPECT_EQ(std::get<PassageFix>(passage.fix->reading).p_body, reader);
}

TEST_F(PassagesTest, WrongIdsAreRefusedAndSayWhy) {
  driveTo(150.5);
  EXPECT_EQ(see("X9").verdict, PassageVerdict::UnknownChamber);
  EXPECT_EQ(see("R650").verdict, PassageVerdict::NotOnTheWay);  // beyond the next junction
  EXPECT_EQ(see("R50").verdict, PassageVerdict::OutOfReach);
  EXPECT_EQ(see("L100").verdict, PassageVerdict::OutOfReach);
  EXPECT_FALSE(see("R50").fix);
}

TEST_F(PassagesTest, TheSamePassageCountsOnce) {
  driveTo(150.5);
  EXPECT_EQ(see("R150").verdict, PassageVerdict::Accepted);
  driveTo(151.5);
  EXPECT_EQ(see("R150").verdict, PassageVerdict::Repeated);
}

TEST_F(PassagesTest, AMissedChamberIsNamedOnceItIsCertainlyPassed) {
  driveTo(150.5);
  EXPECT_EQ(see("R150").verdict, PassageVerdict::Accepted);
  driveTo(380.0);
  ASSERT_EQ(missed.size(), 2u);  // R50 and R350; those of the other side are the other lane's
  EXPECT_EQ(missed[0], "R50");
  EXPECT_EQ(missed[1], "R350");
}

TEST_F(PassagesTest, AnUncertainVehicleNeedsASecondSightingThatAgreesWithTheWayDriven) {
  driveTo(380.0, 25.0);  // +-82 m: R350 and R450 both fit
  EXPECT_EQ(see("R350").verdict, PassageVerdict::Ambiguous);
  driveTo(480.0, 25.0);
  EXPECT_EQ(see("L400").verdict, PassageVerdict::Ambiguous);  // 50 m where 100 m were driven
  driveTo(580.0, 25.0);
  EXPECT_EQ(see("L500").verdict, PassageVerdict::Accepted);  // 100 m after 100 m
}

TEST_F(PassagesTest, TheRoadOffersAFixAcrossAndAHeadingOnceASecondAtMost) {
  RoadAid aid(scene.network, {});
  int offered = 0;
  Measurement last;
  for (; x_ < 110.0; x_ += 0.5) {
    const Estimate estimate = at(x_ / 5.0, x_, 0.5);
    road.take(estimate);
    if (const auto fix = aid.offered(estimate, road)) {
      ++offered;
      last = *fix;
    }
  }
  EXPECT_GE(offered, 18);
  EXPECT_LE(offered, 21);
  EXPECT_FALSE(defect(last));
  const auto& fix = std::get<PassageFix>(last.reading);
  EXPECT_NEAR(*fix.yaw, 0.0, 1e-12);
  EXPECT_NEAR(std::sqrt(fix.covariance(0, 0)), 1000.0, 1e-6);
  const double alike = 30.0 / 5.0;  // correlation length over the way between two fixes
  const double lane = testing::kMainWidth / 2.0;
  EXPECT_NEAR(std::sqrt(fix.covariance(1, 1)), std::sqrt(alike) * lane / std::sqrt(12.0), 0.1);
  EXPECT_NEAR(fix.p_map.y(), -lane / 2.0, 1e-9);  // eastward on the right
}

TEST_F(PassagesTest, TheOtherWayTheRoadOffersTheOtherLane) {
  const auto offeredAt = [this](double yaw) {
    RoadTracker there(scene.network, scene.graph, {});
    RoadAid aid(scene.network, {});
    const Matrix<3, 3> P = Vector<3>(0.25, 0.25, 1e-4).asDiagonal();
    std::optional<Measurement> last;
    for (int i = 0; i < 50; ++i) {
      const double x = 100.0 + std::cos(yaw) * 0.5 * i;
      const Estimate estimate = planarEstimate(stampFromSeconds(0.1 * i), {x, 0.3, yaw}, P);
      there.take(estimate);
      if (const auto fix = aid.offered(estimate, there)) last = fix;
    }
    return last ? std::get<PassageFix>(last->reading).p_map.y() : 0.0;
  };
  EXPECT_NEAR(offeredAt(0.0), -testing::kMainWidth / 4.0, 1e-9);
  EXPECT_NEAR(offeredAt(kPi), testing::kMainWidth / 4.0, 1e-9);
}

TEST_F(PassagesTest, AStandingVehicleIsOfferedNothingMore) {
  RoadAid aid(scene.network, {});
  driveTo(60.0);
  ASSERT_TRUE(aid.offered(at(12.0, 60.0, 0.5), road));
  for (int k = 1; k <= 100; ++k) {
    const Estimate standing = at(12.0 + k, 60.0, 0.5);
    road.take(standing);
    const auto offered = aid.offered(standing, road);
    EXPECT_TRUE(k <= 10 || !offered) << k;  // the smoothed speed needs a moment to fall
  }
}

}  // namespace pos::interval
