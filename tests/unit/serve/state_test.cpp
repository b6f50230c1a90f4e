// The state as JSON.
#include "pos/serve/state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "pos/serve/event_log.hpp"

namespace pos::serve {
namespace {

using nlohmann::json;

Names threeIntervals() {
  Names names{.roadways = {"R11", "R12"}};
  for (int i = 1; i <= 3; ++i) {
    map::LockInterval interval;
    interval.id = "id" + std::to_string(i);
    interval.leg = "j";
    interval.index = i;
    interval.spans = {{1, 0.0, 10.0, map::Lane::Both}};
    names.intervals.push_back(interval);
  }
  return names;
}

interval::IntervalBelief inSecondInterval() {
  interval::IntervalBelief belief{.state = interval::MatchState::Decided, .point = {1, 345.16, 0.4, 0.0}};
  belief.intervals = {{1, 0.97}, {2, 0.03}};
  belief.next = interval::BoundaryAhead{2, true, 12.0, 10.0, 1.0};
  return belief;
}

EstimatorState someEstimate() {
  Matrix<3, 3> P = Matrix<3, 3>::Zero();
  P.diagonal() << 4.0, 1.0, 0.01;
  EstimatorState state{.name = "ekf", .type = "range_odometry"};
  state.estimate = planarEstimate(stampFromSeconds(10), {1, 2, 0.5}, P);
  state.place = inSecondInterval();
  return state;
}

json bodyOf(const Show& show) {
  return json::parse(stateBody(show, threeIntervals()));
}

}  // namespace

TEST(State, TellsAnEstimateWithEllipseAndPlace) {
  Show show{.mode = Mode::Replay, .stamp = stampFromSeconds(10.25)};
  show.estimators = {someEstimate()};
  const json e = bodyOf(show).at("estimators").at(0);
  EXPECT_EQ(e.at("pose").at("yaw_rad"), 0.5);
  EXPECT_DOUBLE_EQ(e.at("age_s"), 0.25);
  EXPECT_DOUBLE_EQ(e.at("ellipse").at("major_m"), 2.0);
  EXPECT_DOUBLE_EQ(e.at("ellipse").at("minor_m"), 1.0);
  EXPECT_NEAR(std::sin(e.at("ellipse").at("angle_rad").get<double>()), 0.0, 1e-12);  // along x
  EXPECT_EQ(e.at("place").at("words"), "R12, 345.2 m, interval j_2, lock held");
  EXPECT_EQ(e.at("place").at("interval_id"), "id2");
  EXPECT_EQ(e.at("place").at("next").at("label"), "j_3");
  EXPECT_EQ(e.at("error_m"), nullptr);
  EXPECT_EQ(e.at("mode"), nullptr);
}

TEST(State, EveryIntervalHasALockState) {
  Show show;
  show.estimators = {someEstimate()};
  const json locks = bodyOf(show).at("locks");
  ASSERT_EQ(locks.size(), 3U);
  EXPECT_EQ(locks[0].at("state"), "free");
  EXPECT_EQ(locks[1].at("state"), "held");
  EXPECT_EQ(locks[2].at("state"), "doubtful");
  show.estimators[0].place->state = interval::MatchState::Lost;
  const json lost = bodyOf(show);
  for (const json& lock : lost.at("locks")) EXPECT_EQ(lock.at("state"), "unknown");
  EXPECT_EQ(bodyOf(show).at("estimators")[0].at("place").at("roadway"), nullptr);
}

TEST(State, WhatIsNotKnownIsNull) {
  const json body = bodyOf({.mode = Mode::Live});
  EXPECT_EQ(body.at("stamp_s"), nullptr);
  EXPECT_EQ(body.at("truth"), nullptr);
  EXPECT_EQ(body.at("recording"), nullptr);
  EXPECT_TRUE(body.at("estimators").empty());
  Show show;
  show.estimators = {{.name = "ekf"}};
  const json e = bodyOf(show).at("estimators").at(0);
  for (const char* key : {"pose", "sigma", "ellipse", "place", "stamp_s", "nis"})
    EXPECT_EQ(e.at(key), nullptr) << key;
  show.estimators[0].estimate = planarEstimate({}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {});
  EXPECT_EQ(bodyOf(show).at("estimators").at(0).at("pose").at("x_m"), nullptr);
}

TEST(State, ModesComeFromTheDiagnostics) {
  Show show;
  show.estimators = {someEstimate()};
  show.estimators[0].modes =
      modesOf({{"range_bias_m", 1.0, 0.1}, {"probability_gnss", 0.2, 0.0}, {"probability_uwb", 0.8, 0.0}});
  const json e = bodyOf(show).at("estimators").at(0);
  ASSERT_EQ(e.at("modes").size(), 2U);
  EXPECT_EQ(e.at("mode"), "uwb");
  EXPECT_EQ(e.at("modes")[0].at("name"), "gnss");
}

TEST(State, AnchorsAreSeenRejectedOrNotSeen) {
  Show show;
  const Link heard{.state = Connection::Connected, .last_tested = Verdict::Applied};
  show.connections.anchors = {{1, heard},
                              {2, {.state = Connection::Connected, .last_tested = Verdict::Gated}},
                              {3, {.state = Connection::Lost, .last_tested = Verdict::Applied}},
                              {4, {}}};
  const json anchors = bodyOf(show).at("anchors");
  EXPECT_EQ(anchors[0].at("seen"), "seen");
  EXPECT_EQ(anchors[1].at("seen"), "rejected");
  EXPECT_EQ(anchors[2].at("seen"), "not_seen");
  EXPECT_EQ(anchors[3].at("seen"), "not_seen");
}

TEST(State, TheNumberStandsInFront) {
  const std::string body = stateBody({}, {});
  EXPECT_EQ(json::parse(withSeq(7, body)).at("seq"), 7);
  EXPECT_EQ(body, stateBody({}, {}));
}

TEST(State, LabelsThatAreNoUtf8StayReadable) {
  Show show;
  show.connections.sources = {{"\xFFuwb", "range", {}}};
  EXPECT_NO_THROW((void)bodyOf(show));
}

TEST(EventLog, NumbersStayWhenTheOldestGo) {
  EventLog log;
  for (std::size_t i = 0; i < EventLog::kMost + 10; ++i)
    log.add({.stamp = stampFromSeconds(static_cast<double>(i)), .estimator = "ekf", .kind = "k"});
  EXPECT_EQ(log.total(), EventLog::kMost + 10);
  const json first = json::parse(log.json(0, 2));
  ASSERT_EQ(first.at("events").size(), 2U);
  EXPECT_EQ(first.at("events")[0].at("n"), 10);
  EXPECT_EQ(first.at("events")[0].at("stamp_s"), 10.0);
  const json last = json::parse(log.json(EventLog::kMost + 9, 100));
  EXPECT_EQ(last.at("events").size(), 1U);
  EXPECT_TRUE(json::parse(log.json(1ULL << 40, 5)).at("events").empty());
}

TEST(IntervalsJson, NamesTheRoadways) {
  const json list = json::parse(intervalsJson(threeIntervals())).at("intervals");
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].at("label"), "j_1");
  EXPECT_EQ(list[0].at("spans")[0].at("roadway"), "R12");
  EXPECT_EQ(list[0].at("length_m"), 10.0);
}

TEST(State, LocksAreThoseOfTheRulesWhereTheyAreTold) {
  Show show{.mode = Mode::Live};
  show.estimators = {someEstimate(), someEstimate()};
  show.locks = {Occupancy::Held, Occupancy::Doubtful, Occupancy::Free};
  const json body = bodyOf(show);
  EXPECT_EQ(body.at("locks").at(0).at("state"), "held");
  EXPECT_EQ(body.at("locks").at(1).at("state"), "doubtful");
  EXPECT_EQ(body.at("locks").at(2).at("state"), "free");
  EXPECT_NEAR(body.at("locks").at(1).at("probability").get<double>(), 0.97, 1e-12);
  EXPECT_EQ(body.at("estimators").at(0).at("place").at("lock"), "doubtful");
  EXPECT_EQ(body.at("estimators").at(1).at("place").at("lock"), "held") << "the rules judge the first one";
  show.estimators.front().place.reset();
  EXPECT_TRUE(bodyOf(show).at("locks").at(0).at("probability").is_null());
}

}  // namespace pos::serve
