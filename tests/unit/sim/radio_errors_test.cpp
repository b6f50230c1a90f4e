#include "pos/sim/radio_errors.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "pos/core/error.hpp"
#include "pos/sim/uwb_stream.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::meanBand;
using scene::meanOf;
using scene::rateBand;
using scene::rateOf;
using scene::sigmaOf;

const std::vector<map::Anchor> kTwo{{.id = 1, .p_map = {0, 40, 0}}, {.id = 2, .p_map = {30, -40, 0}}};
const Eigen::Vector3d kPlace(0, 0, 0);

/// A radio without noise: what is left is the error under test.
UwbConfig silentNoise(double rate = 10.0) {
  UwbConfig config;
  config.timing.rate = rate;
  config.tags = {{.id = 7}, {.id = 8}};
  config.sigma = 0.0;
  return config;
}

struct Error {
  double t = 0.0;
  TagId tag = 0;
  AnchorId anchor = 0;
  double size = 0.0;
};

std::vector<Error> errorsOf(const UwbConfig& config, double duration, const LineOfSight& view = {},
                            const std::vector<map::Anchor>& anchors = kTwo) {
  UwbStream stream(config, anchors, scene::standing(kPlace, duration), {.seed = 3}, view);
  std::vector<Error> errors;
  while (const std::optional<Delivery> delivery = stream.next()) {
    const auto& r = std::get<BeaconRange>(delivery->measurement.reading);
    const double truth = (kPlace - kTwo[static_cast<std::size_t>(r.anchor - 1)].p_map).norm();
    errors.push_back({scene::secondsOf(*delivery), r.tag, r.anchor, r.range - truth});
  }
  return errors;
}

std::vector<double> sizes(const std::vector<Error>& errors) {
  std::vector<double> all;
  for (const Error& error : errors) all.push_back(error.size);
  return all;
}

std::vector<double> sizesOf(const std::vector<Error>& errors, TagId tag, AnchorId anchor) {
  std::vector<double> all;
  for (const Error& error : errors) {
    if (error.tag == tag && error.anchor == anchor) all.push_back(error.size);
  }
  return all;
}

bool present(double error) {
  return std::abs(error) > 1e-9;
}

std::vector<double> onlyPresent(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !present(value); });
  return values;
}

}  // namespace

TEST(BiasLaw, UniformHasItsMeanAndLimits) {
  RandomStream random(1, 1);
  std::vector<double> values;
  for (int i = 0; i < 50000; ++i) values.push_back(drawn(BiasLaw::uniform(0.3, 1.5), random));
  EXPECT_NEAR(meanOf(values), 0.9, meanBand(1.2 / std::sqrt(12.0), values.size()));
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.3);
  EXPECT_LE(*std::max_element(values.begin(), values.end()), 1.5);
}

TEST(BiasLaw, CutExponentialHasTheMeanOfItsTruncatedLaw) {
  RandomStream random(1, 2);
  std::vector<double> values;
  for (int i = 0; i < 50000; ++i) values.push_back(drawn(BiasLaw::exponential(0.6, 0.5, 2.0), random));
  const double x = 1.5 / 0.6;
  const double mean = 0.5 + 0.6 - 1.5 / std::expm1(x);  // of an exponential cut off at 1.5 above 0.5
  EXPECT_NEAR(meanOf(values), mean, meanBand(sigmaOf(values), values.size()));
  EXPECT_LE(*std::max_element(values.begin(), values.end()), 2.0);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.5);

  std::vector<double> endless;
  for (int i = 0; i < 50000; ++i) endless.push_back(drawn(BiasLaw::exponential(0.6), random));
  EXPECT_NEAR(meanOf(endless), 0.6, meanBand(0.6, endless.size()));
}

TEST(RadioErrors, OutliersHaveTheirRateSignsAndSizes) {
  UwbConfig config = silentNoise();
  config.errors.outliers = {.probability = 0.05, .short_share = 0.3, .size = BiasLaw::uniform(2.0, 20.0)};
  const std::vector<double> all = sizes(errorsOf(config, 2000.0));
  EXPECT_NEAR(rateOf(all, present), 0.05, rateBand(0.05, all.size()));
  const std::vector<double> outliers = onlyPresent(all);
  EXPECT_NEAR(rateOf(outliers, [](double e) { return e < 0.0; }), 0.3, rateBand(0.3, outliers.size()));
  std::vector<double> magnitude;
  for (const double e : outliers) magnitude.push_back(std::abs(e));
  EXPECT_NEAR(meanOf(magnitude), 11.0, meanBand(18.0 / std::sqrt(12.0), magnitude.size()));
}

TEST(RadioErrors, MultipathLengthensItsShareOfRanges) {
  UwbConfig config = silentNoise();
  config.errors.multipath = {.probability = 0.1, .excess = BiasLaw::exponential(0.5)};
  const std::vector<double> all = sizes(errorsOf(config, 1000.0));
  EXPECT_NEAR(rateOf(all, present), 0.1, rateBand(0.1, all.size()));
  const std::vector<double> echoes = onlyPresent(all);
  EXPECT_NEAR(meanOf(echoes), 0.5, meanBand(0.5, echoes.size()));
}

TEST(RadioErrors, DropOutsLoseTheirShareOfRanges) {
  UwbConfig config = silentNoise();
  config.errors.drop_probability = 0.2;
  const std::size_t possible = 10001U * 4U;
  const std::size_t heard = errorsOf(config, 1000.0).size();
  EXPECT_NEAR(static_cast<double>(heard) / static_cast<double>(possible), 0.8, rateBand(0.2, possible));
}

// Spec B A8.1: p = 0.15 per anchor and 0.5 s, bias U(0.3, 1.5).
TEST(RadioErrors, BlocksHideAnAnchorWithOneBiasABlockForAllTags) {
  UwbConfig config = silentNoise();
  config.errors.blocks = NlosBlocks{};
  const std::vector<Error> errors = errorsOf(config, 4000.0);
  std::map<std::pair<AnchorId, int>, std::set<double>> of_block;
  for (const Error& e : errors) {
    of_block[{e.anchor, static_cast<int>(e.t / 0.5 + 1e-6)}].insert(std::round(e.size * 1e9) * 1e-9);
  }
  std::vector<double> biases;
  for (const auto& [block, values] : of_block) {
    EXPECT_EQ(values.size(), 1U);
    biases.push_back(*values.begin());
  }
  EXPECT_NEAR(rateOf(biases, present), 0.15, rateBand(0.15, biases.size()));
  const std::vector<double> hidden = onlyPresent(biases);
  EXPECT_NEAR(meanOf(hidden), 0.9, meanBand(1.2 / std::sqrt(12.0), hidden.size()));
  // A hidden block says nothing of the next: the share of hidden ones after hidden ones is the same.
  std::vector<double> after;
  for (const auto& [block, values] : of_block) {
    const auto next = of_block.find({block.first, block.second + 1});
    if (present(*values.begin()) && next != of_block.end()) after.push_back(*next->second.begin());
  }
  EXPECT_NEAR(rateOf(after, present), 0.15, rateBand(0.15, after.size()));
}

TEST(RadioErrors, MarkovProcessHasItsMeanSpells) {
  UwbConfig config = silentNoise(100.0);
  config.tags.pop_back();
  config.errors.process =
      NlosProcess{.mean_free = 3.0, .mean_hidden = 1.0, .bias = BiasLaw::uniform(0.3, 1.5)};
  const std::vector<double> all = sizesOf(errorsOf(config, 8000.0), 7, 1);
  // A spell ends when the bias changes to or from nothing; two spells of one kind cannot touch.
  std::vector<double> free_spells;
  std::vector<double> hidden_spells;
  double since = 0.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (present(all[i]) == present(all[i - 1])) continue;
    const double now = 0.01 * static_cast<double>(i);
    if (since > 0.0) (present(all[i - 1]) ? hidden_spells : free_spells).push_back(now - since);
    since = now;
  }
  ASSERT_GT(hidden_spells.size(), 1500U);
  // Spells shorter than a sample go unseen and join their neighbours: up to 1 % of the shorter kind.
  EXPECT_NEAR(meanOf(free_spells), 3.0, meanBand(3.0, free_spells.size()) + 0.04);
  EXPECT_NEAR(meanOf(hidden_spells), 1.0, meanBand(1.0, hidden_spells.size()) + 0.01);
  EXPECT_NEAR(sigmaOf(hidden_spells), 1.0,
              2.0 * meanBand(1.0, hidden_spells.size()));  // sigma = mean; its own sigma is 1.41 / sqrt(n)
  // Share of hidden time: 2 p (1 - p) / (rates' sum) / T is its variance over a long time T.
  const double variance = 2.0 * 0.25 * 0.75 / (1.0 / 3.0 + 1.0) / 8000.0;
  EXPECT_NEAR(rateOf(all, present), 0.25, scene::kBand * std::sqrt(variance));
}

TEST(RadioErrors, MarkovProcessStartsInItsStationaryState) {
  UwbConfig config = silentNoise();
  config.errors.process = NlosProcess{.mean_free = 3.0, .mean_hidden = 1.0};
  std::vector<double> first;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    UwbStream stream(config, kTwo, scene::standing(kPlace, 0.0), {.seed = seed});
    first.push_back(std::get<BeaconRange>(stream.next()->measurement.reading).range - 40.0);
  }
  EXPECT_NEAR(rateOf(first, present), 0.25, rateBand(0.25, first.size()));
}

// Spec A 3.5, A4: one anchor, 3 s, +0.5 to +2 m.
TEST(RadioErrors, EpisodeHidesOneAnchorForItsTime) {
  UwbConfig config = silentNoise();
  config.errors.episodes = {{.anchor = 1, .when = {5.0, 8.0}, .bias = BiasLaw::exponential(0.5, 0.5, 2.0)}};
  std::set<double> seen;
  for (const Error& e : errorsOf(config, 20.0)) {
    const bool hidden = e.anchor == 1 && e.t >= 5.0 && e.t < 8.0;
    EXPECT_EQ(present(e.size), hidden) << e.t;
    if (hidden) seen.insert(std::round(e.size * 1e9) * 1e-9);
  }
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_GE(*seen.begin(), 0.5);
  EXPECT_LE(*seen.begin(), 2.0);
}

TEST(RadioErrors, RockLosesARangeOrDelaysIt) {
  const LineOfSight south_is_rock = [](const Eigen::Vector3d&, const Eigen::Vector3d& q) {
    return q.y() > 0.0;
  };
  UwbConfig config = silentNoise();
  for (const Error& e : errorsOf(config, 10.0, south_is_rock)) EXPECT_EQ(e.anchor, 1);
  config.errors.obstruction = {.effect = Obstruction::Effect::Delayed, .bias = BiasLaw::uniform(0.3, 1.5)};
  const std::vector<Error> errors = errorsOf(config, 10.0, south_is_rock);
  EXPECT_EQ(errors.size(), 101U * 4U);
  for (const Error& e : errors) EXPECT_EQ(present(e.size), e.anchor == 2);
  EXPECT_LT(sigmaOf(sizesOf(errors, 7, 2)), 1e-9);                            // one spell, one bias
  EXPECT_TRUE(present(sizesOf(errors, 7, 2)[0] - sizesOf(errors, 8, 2)[0]));  // each link its own
}

TEST(RadioErrors, SilencedLinksAreNotHeard) {
  UwbConfig config = silentNoise();
  config.errors.silences = {{.anchor = 2, .tag = 7, .when = {2.0, 4.0}}, {.anchor = 1, .when = {6.0, 7.0}}};
  std::map<std::pair<TagId, AnchorId>, int> heard;
  for (const Error& e : errorsOf(config, 9.95)) heard[{e.tag, e.anchor}] += 1;
  EXPECT_EQ((heard[{7, 1}]), 90);
  EXPECT_EQ((heard[{8, 1}]), 90);
  EXPECT_EQ((heard[{7, 2}]), 80);
  EXPECT_EQ((heard[{8, 2}]), 100);
}

TEST(RadioErrors, ScaleAndOffsetApplyToTheLinksNamed) {
  UwbConfig config = silentNoise();
  config.errors.links = {
      {.scale = 0.01}, {.tag = 7, .offset = 0.2}, {.tag = 8, .anchor = 2, .scale = 0.02, .offset = -0.1}};
  for (const Error& e : errorsOf(config, 1.0)) {
    const double truth = e.anchor == 1 ? 40.0 : 50.0;
    const double extra = e.anchor == 2 ? 0.02 * truth - 0.1 : 0.0;
    EXPECT_NEAR(e.size, 0.01 * truth + (e.tag == 7 ? 0.2 : extra), 1e-12);
  }
}

TEST(RadioErrors, SpreadDrawsAScaleAndAnOffsetALinkAndRun) {
  std::vector<double> offsets;
  UwbConfig config = silentNoise();
  config.errors.spread = {.offset_low = 0.05, .offset_high = 0.3};
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    UwbStream stream(config, kTwo, scene::standing(kPlace, 0.0), {.seed = seed});
    for (const BeaconRange& r : scene::readings<BeaconRange>(scene::drained(stream))) {
      offsets.push_back(r.range - (r.anchor == 1 ? 40.0 : 50.0));
    }
  }
  EXPECT_NEAR(meanOf(offsets), 0.175, meanBand(0.25 / std::sqrt(12.0), offsets.size()));
  EXPECT_GE(*std::min_element(offsets.begin(), offsets.end()), 0.05 - 1e-9);
  EXPECT_LE(*std::max_element(offsets.begin(), offsets.end()), 0.3 + 1e-9);
}

TEST(RadioErrors, AnchorsBeyondReachAreNotHeardAndKnownBiasIsInTheRange) {
  UwbConfig config = silentNoise();
  config.range_max = 45.0;
  std::vector<map::Anchor> anchors = kTwo;
  anchors[0].range_bias = 0.25;
  for (const Error& e : errorsOf(config, 1.0, {}, anchors)) {
    EXPECT_EQ(e.anchor, 1);
    EXPECT_NEAR(e.size, 0.25, 1e-12);
  }
}

TEST(RadioErrors, SurveyErrorMovesAnchorsForTheWholeRun) {
  UwbConfig config = silentNoise();
  config.survey_error = 1.0;
  std::vector<map::Anchor> anchors = kTwo;
  anchors[0].survey_sigma = 0.1;
  std::vector<double> shifts;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    UwbStream stream(config, anchors, scene::standing(kPlace, 0.0), {.seed = seed});
    shifts.push_back(std::get<BeaconRange>(stream.next()->measurement.reading).range - 40.0);
  }
  EXPECT_NEAR(sigmaOf(shifts), 0.1, scene::sigmaBand(0.1, shifts.size()));
}

TEST(RadioErrors, RangeThatWouldBeNegativeIsNotDelivered) {
  UwbConfig config = silentNoise();
  config.errors.links = {{.anchor = 1, .offset = -41.0}};
  for (const Error& e : errorsOf(config, 1.0)) EXPECT_EQ(e.anchor, 2);
}

TEST(RadioErrors, RefusesLawsThatCannotBe) {
  EXPECT_THROW((void)validated(BiasLaw::uniform(1.0, 0.5), "b"), ConfigError);
  EXPECT_THROW((void)validated(BiasLaw::exponential(0.0), "b"), ConfigError);
  EXPECT_THROW((void)validated(RadioErrors{.process = NlosProcess{.mean_free = 0.0}}, "e"), ConfigError);
  EXPECT_THROW((void)validated(RadioErrors{.blocks = NlosBlocks{.probability = 1.5}}, "e"), ConfigError);
}

}  // namespace pos::sim
