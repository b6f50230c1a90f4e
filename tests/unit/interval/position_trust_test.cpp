#include "pos/interval/position_trust.hpp"

#include <gtest/gtest.h>

namespace pos::interval {
namespace {

constexpr auto kEstimate = Report::Evidence::Estimate;

TrackPoint at(double t, double distance, double sigma = 1.0) {
  return {stampFromSeconds(t), distance, sigma};
}

/// A vehicle that has driven 4 m/s for ten seconds with good reports.
PositionTrust driven() {
  PositionTrust trust({}, 7.0);
  for (double t = 0.0; t <= 10.0; t += 1.0) trust.take(at(t, 4.0 * t), 4.0, kEstimate);
  return trust;
}

}  // namespace

TEST(PositionTrust, BelievesWhatTheWheelsConfirm) {
  const PositionTrust trust = driven();
  EXPECT_TRUE(trust.trusted());
  EXPECT_EQ(trust.believed()->distance, 40.0);
}

TEST(PositionTrust, ABackwardJumpIsAsDoubtfulAsAForwardOne) {
  for (const double jump : {-15.0, 15.0}) {
    PositionTrust trust = driven();
    trust.take(at(11.0, 44.0 + jump), 4.0, kEstimate);
    EXPECT_FALSE(trust.trusted()) << jump;
    EXPECT_EQ(trust.believed()->distance, 40.0);
    trust.take(at(12.0, 48.0), 4.0, kEstimate);
    EXPECT_TRUE(trust.trusted()) << jump;
  }
}

TEST(PositionTrust, VagueReportsDoNotPullTheTrackToAWrongPlaceWhereASharpOneIsThenBelieved) {
  PositionTrust trust = driven();
  for (double t = 11.0; t <= 14.0; t += 1.0) trust.take(at(t, 40.0 + 18.0, 8.0), 0.0, kEstimate);
  trust.take(at(15.0, 40.0 + 18.0, 1.0), 0.0, kEstimate);
  EXPECT_FALSE(trust.trusted());
  trust.take(at(16.0, 40.5, 1.0), 0.0, kEstimate);
  EXPECT_TRUE(trust.trusted());
}

TEST(PositionTrust, AfterAGapAStepStartsTheWaitingAnew) {
  PositionTrust trust = driven();
  double t = 40.0;
  for (; t < 48.0; t += 1.0) trust.take(at(t, 130.0), 0.0, kEstimate);  // a jump that lasts eight seconds
  for (; t < 58.0; t += 1.0) {
    trust.take(at(t, 100.0), 0.0, kEstimate);
    EXPECT_FALSE(trust.trusted()) << t;
  }
  trust.take(at(t, 100.0), 0.0, kEstimate);
  EXPECT_TRUE(trust.trusted());
}

TEST(PositionTrust, APassageEndsEveryDoubtAndAProvenPlaceBeginsWithout) {
  PositionTrust trust = driven();
  trust.take(at(11.0, 90.0), 4.0, kEstimate);
  trust.take(at(12.0, 48.2, 0.4), 4.0, Report::Evidence::Passage);
  EXPECT_TRUE(trust.trusted());
  trust.lose();
  EXPECT_FALSE(trust.trusted());
  trust.prove(at(20.0, 60.0, 0.5));
  EXPECT_TRUE(trust.trusted());
}

}  // namespace pos::interval
