#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "complaint.hpp"
#include "config_text.hpp"
#include "pos/core/angle.hpp"
#include "pos/estimation/factory.hpp"
#include "pos/io/run_config.hpp"

namespace pos::io {
namespace {

using estimation::MclConfig;
using estimation::MrptMclConfig;
using estimation::RangeOdometryConfig;
using pos::test::complaintOf;
using pos::test::kFullConfig;
using testing::HasSubstr;

constexpr const char* kHead = "schema: 1\nname: run\nestimators:\n";

RunConfig load(const std::string& text) {
  return runConfigFrom(parseYaml(text, "/site/configs/uwb/run.yaml"), "/share");
}
Complaint refusal(const std::string& text) {
  return complaintOf([&] { return load(text); });
}

TEST(ConfigRun, EveryKeyReachesItsMember) {
  const RunConfig run = load(kFullConfig);
  EXPECT_EQ(run.log->file, "/share/datasets/uwb.rawlog");
  EXPECT_EQ(run.map, "/site/maps/uwb_demo/map.yaml");
  EXPECT_EQ(run.truth->file, "/site/configs/uwb/truth.txt");
  EXPECT_EQ(run.truth->format, TruthSource::Format::MrptIndex);
  EXPECT_EQ(run.truth->T_map_truth.y, 4.0);
  EXPECT_DOUBLE_EQ(run.truth->T_map_truth.yaw, radians(15.0));
  EXPECT_EQ(run.seed, 18446744073709551615ULL);
  EXPECT_EQ(run.faults, (FaultConfig{0.2, 4.0, 21.0, 5}));
  EXPECT_EQ(run.sensors, (std::vector<SensorConfig>{{"UWB", false, 0.05}, {"laser front", true, 0.0}}));
  EXPECT_EQ(run.evaluation, (EvaluationConfig{EvaluationConfig::Align::PosYaw, 3.0, 2.0, -0.1, 0.15}));
  ASSERT_EQ(run.estimators.size(), 4u);
  const auto& range_odometry = std::get<RangeOdometryConfig>(run.estimators[1].config);
  EXPECT_EQ(range_odometry.motion, RangeOdometryConfig::Motion::ConstantVelocity);
  EXPECT_EQ(range_odometry.start.mode, estimation::StartMode::UnknownHeading);
  EXPECT_EQ(range_odometry.tags[1].id, 7);
  EXPECT_EQ(range_odometry.tags[0].p_body, Eigen::Vector3d(0.16, 0.1, 1.12));
  EXPECT_DOUBLE_EQ(range_odometry.gyro_bias.walk_per_sqrt_s, radians(0.03));
  EXPECT_EQ(range_odometry.latency, (estimation::CalibrationState{0.05, 0.02, 0.001}));
  EXPECT_EQ(range_odometry.gate, (estimation::GateConfig{0.99, 4.0, 0.5, 9.0}));
  const auto& mcl = std::get<MclConfig>(run.estimators[2].config);
  EXPECT_EQ(mcl.particles.max, 30000);
  EXPECT_EQ(mcl.scan, (estimation::ScanLikelihood{90, 0.2, 0.3, 2.0, 0.5, 0.25}));
  EXPECT_EQ(mcl.seed, 42u);
  const auto& yardstick = std::get<MrptMclConfig>(run.estimators[3].config);
  EXPECT_FALSE(yardstick.adaptive_size);
  EXPECT_EQ(yardstick.particles, 3000);
  EXPECT_EQ(yardstick.odometry_noise.position_per_sqrt_s, 0.003);
}

/// Paths of all leaves that the text of a config shows with the same value as the text of the defaults.
std::vector<std::string> equalLeaves(const YamlNode& a, const YamlNode& b, const std::string& path) {
  if (a.kind == YamlNode::Kind::Scalar) {
    return a.text == b.text ? std::vector<std::string>{path} : std::vector<std::string>{};
  }
  std::vector<std::string> equal;
  for (std::size_t i = 0; a.kind == YamlNode::Kind::Table && i < a.items.size(); ++i) {
    const YamlNode* other = b.find(a.keys[i].name);
    if (other == nullptr) continue;
    for (const auto& leaf : equalLeaves(a.items[i], *other, joinedPath(path, a.keys[i].name)))
      equal.push_back(leaf);
  }
  return equal;
}

TEST(ConfigRun, TheFullTextDiffersFromTheDefaultsAndSoProvesEveryRow) {
  const RunConfig run = load(kFullConfig);
  const YamlNode range_odometry =
      writeTable(*rangeOdometryOptions().core(), &std::get<RangeOdometryConfig>(run.estimators[1].config),
                 Comments::None);
  const RangeOdometryConfig defaults;
  const YamlNode plain = writeTable(*rangeOdometryOptions().core(), &defaults, Comments::None);
  for (const std::string& leaf : equalLeaves(range_odometry, plain, "")) {
    EXPECT_TRUE(leaf.starts_with("start.") || leaf.starts_with("odometry_noise.")) << leaf;
  }
}

TEST(ConfigRun, ResolvedTextLoadsBackToAnEqualStruct) {
  const RunConfig run = load(kFullConfig);
  const YamlDocument elsewhere = parseYaml(resolvedYaml(run), "/other/run.yaml");
  EXPECT_EQ(runConfigFrom(elsewhere, "/nowhere"), run);
}

TEST(ConfigRun, ResolvedTextOfDefaultsLoadsBackToAnEqualStruct) {
  RunConfig run;
  run.name = "defaults";
  run.estimators = {{"a", estimation::DeadReckoningConfig{}},
                    {"b", RangeOdometryConfig{}},
                    {"c", MclConfig{}},
                    {"d", MrptMclConfig{}}};
  EXPECT_EQ(load(resolvedYaml(run)), run);
}

TEST(ConfigRun, ExampleLoads) {
  const RunConfig run = load(exampleRunConfig());
  EXPECT_EQ(run.name, "my_run");
  EXPECT_EQ(run.map, "/site/configs/uwb/map.yaml");
  EXPECT_EQ(run.estimators[0].config, estimation::EstimatorConfig{RangeOdometryConfig{}});
  EXPECT_THAT(exampleRunConfig(),
              HasSubstr("    # Standard deviation of a range. (a number in m, 0.001 to 100)\n"
                        "    range_sigma_m: 0.1\n"));
}

TEST(ConfigRun, LogMapAndTruthMayBeAbsent) {
  const RunConfig run = load(std::string(kHead) + "  - {name: a, type: mcl}\n");
  EXPECT_FALSE(run.log || run.map || run.truth);
  EXPECT_EQ(run.estimators[0].config, estimation::EstimatorConfig{MclConfig{}});
}

TEST(ConfigRun, NestedKeyPathAndPlaceOfABadValue) {
  const Complaint complaint =
      refusal(std::string(kHead) +
              "  - {name: a, type: mcl}\n  - name: b\n    type: mcl\n    range:\n      sigma_m: -1\n");
  EXPECT_EQ(complaint.key, "estimators[1].range.sigma_m");
  EXPECT_EQ(toString(complaint.place), "/site/configs/uwb/run.yaml:8:16");
  EXPECT_EQ(complaint.expected, "a number in m, 0.001 to 100");
}

TEST(ConfigRun, KeyOfAnotherTypeIsExplained) {
  const Complaint complaint =
      refusal(std::string(kHead) + "  - {name: a, type: range_odometry, particles: {min: 3}}\n");
  EXPECT_EQ(complaint.what, "unknown key 'particles'");
  EXPECT_EQ(complaint.suggestion, "this key belongs to type: mcl");
}

TEST(ConfigRun, WrongUnitOfSeveralKeysNamesThemAll) {
  const Complaint complaint =
      refusal(std::string(kHead) + "  - {name: a, type: mcl, odometry_noise: {yaw_rad_per_sqrt_s: 1}}\n");
  EXPECT_EQ(complaint.suggestion,
            "wrong unit: use yaw_deg_per_sqrt_m or yaw_deg_per_sqrt_deg or yaw_deg_per_sqrt_s");
}

TEST(ConfigRun, TypeNamesAreThoseOfTheFile) {
  const RunConfig run = load(kFullConfig);
  const YamlDocument document = parseYaml(resolvedYaml(run), "run.yaml");
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    EXPECT_EQ(document.root.find("estimators")->items[i].find("type")->text,
              typeName(run.estimators[i].config));
  }
}

TEST(ConfigRun, ValidatedFindsWhatTheReaderFinds) {
  RunConfig run = load(kFullConfig);
  EXPECT_EQ(validated(run), run);
  run.estimators[1].name = run.estimators[0].name;
  EXPECT_EQ(complaintOf([&] { return validated(run); }).key, "estimators[1].name");
  run = load(kFullConfig);
  std::get<MclConfig>(run.estimators[2].config).range.sigma = -1.0;
  EXPECT_EQ(complaintOf([&] { return validated(run); }).key, "estimators[2].range.sigma_m");
  run = load(kFullConfig);
  run.faults.range_outlier_min = 100.0;
  EXPECT_EQ(complaintOf([&] { return validated(run); }).key, "faults.range_outlier_min_m");
  run.faults = {};
  run.truth->file.reset();
  EXPECT_EQ(complaintOf([&] { return validated(run); }).key, "truth.file");
}

TEST(ConfigRun, UnknownTypeIsRefusedWithTheNearestOne) {
  const Complaint complaint = refusal(std::string(kHead) + "  - {name: a, type: range_odometri}\n");
  EXPECT_EQ(complaint.key, "estimators[0].type");
  EXPECT_EQ(
      complaint.expected,
      "one of: dead_reckoning, range_odometry, mcl, mrpt_mcl, dual_uwb, sins_dr, uwb_imu, seamless, shearer");
  EXPECT_EQ(complaint.suggestion, "did you mean range_odometry?");
}

TEST(ConfigRun, MissingTypeIsRefused) {
  const Complaint complaint = refusal(std::string(kHead) + "  - name: a\n");
  EXPECT_EQ(complaint.what, "the key 'type' is missing");
  EXPECT_EQ(complaint.key, "estimators[0].type");
}

TEST(ConfigRun, EstimatorNamesAreUniqueAndFitFiles) {
  const Complaint twice =
      refusal(std::string(kHead) + "  - {name: a, type: mcl}\n  - {name: a, type: mcl}\n");
  EXPECT_EQ(twice.what, "two estimators have the same name");
  EXPECT_EQ(twice.key, "estimators[1].name");
  EXPECT_EQ(twice.place.line, 5);
  EXPECT_EQ(refusal(std::string(kHead) + "  - {name: a/b, type: mcl}\n").what,
            "the name does not fit a file name");
  EXPECT_EQ(refusal("schema: 1\nname: run\nestimators: []\n").what, "there is no estimator to run");
  EXPECT_EQ(refusal("schema: 1\nname: run\n").what, "the key 'estimators' is missing");
}

TEST(ConfigRun, OtherSchemaIsRefused) {
  const Complaint complaint = refusal("schema: 2\nname: run\nestimators: [{name: a, type: mcl}]\n");
  EXPECT_EQ(complaint.what, "the value is too large");
  EXPECT_EQ(complaint.expected, "a whole number, 1");
}

TEST(ConfigRun, RulesAcrossKeysHaveTheirPlace) {
  const std::string head = "schema: 1\nname: run\nestimators: [{name: a, type: mcl}]\n";
  const Complaint faults = refusal(head + "faults:\n  range_outlier_max_m: 1\n  range_outlier_min_m: 2\n");
  EXPECT_EQ(faults.key, "faults.range_outlier_min_m");
  EXPECT_EQ(faults.place.line, 6);
  EXPECT_EQ(refusal(head + "truth: {format: tum}\n").what, "the truth has no file");
  EXPECT_THAT(refusal(head + "truth: {format: log, file: x}\n").what, HasSubstr("yet a file is named"));
  EXPECT_EQ(refusal(head + "sensors: [{sensor: a}, {sensor: a}]\n").key, "sensors[1].sensor");
  const Complaint particles = refusal(
      std::string(kHead) + "  - name: a\n    type: mcl\n    particles:\n      max: 10\n      min: 20\n");
  EXPECT_EQ(particles.key, "estimators[0].particles.min");
  EXPECT_EQ(particles.place.line, 8);
  const Complaint tags =
      refusal(std::string(kHead) +
              "  - name: a\n    type: mcl\n    tags:\n      - {id: 3, x_m: 0, y_m: 0, z_m: 0}\n"
              "      - {id: 3, x_m: 1, y_m: 0, z_m: 0}\n");
  EXPECT_EQ(tags.key, "estimators[0].tags[1].id");
  EXPECT_EQ(tags.place.line, 8);
}

TEST(ConfigRun, MessageReadsAsInTheManual) {
  try {
    (void)runConfigFrom(
        parseYaml(std::string(kHead) + "  - name: a\n    type: mcl\n    range:\n      sigma_cm: 20\n",
                  "configs/uwb_demo.yaml"),
        "/share");
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "configs/uwb_demo.yaml:7:7: unknown key 'sigma_cm'\n"
                 "  key:      estimators[0].range.sigma_cm\n"
                 "  try:      wrong unit: use sigma_m");
    EXPECT_EQ(error.exitCode(), 3);
  }
}

TEST(ConfigRun, FileAndOverridesAreLoaded) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "ConfigRunLoad";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "run.yaml") << kFullConfig;
  const RunConfig run =
      loadRunConfig(folder / "run.yaml", {"estimators.mcl-1.seed=43", "map=other.yaml"}, "/share");
  EXPECT_EQ(std::get<MclConfig>(run.estimators[2].config).seed, 43u);
  EXPECT_EQ(run.map, (folder / "other.yaml").lexically_normal());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pos::io
