#include "pos/io/scenario_yaml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "complaint.hpp"
#include "pos/core/angle.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using pos::test::complaintOf;
using testing::HasSubstr;

const std::string kVehicle = R"(schema: 1
name: cart
steering: differential
length_m: 1
width_m: 0.5
height_m: 0.5
wheel_radius_m: 0.1
max_speed_m_per_s: 2
encoder_track_m: 0.4
mounts: [{name: roof, x_m: 0.1, y_m: 0, z_m: 0.5}]
)";

const std::string kScenario = R"(schema: 1
name: try
map: ../maps/hall/map.yaml
vehicle_file: cart.yaml
vehicle: {wheel_radius_m: 0.11}
motion:
  type: segments
  start: {heading_deg: 90}
  segments:
    - {duration_s: 1, speed_to_m_per_s: 1}
    - {duration_s: 3, turn: {by_deg: 45, blend: trapezoid, ramp_s: 0.5}}
sensors:
  - {name: imu, type: imu, mount: roof, grade: navigation, gyro: {bias_deg_per_h: [1, 2, 3]}}
  - name: uwb
    type: uwb
    tags: [{id: 3, mount: roof}]
    zones: [{time: {from_s: 1, to_s: 2}, sigma_m: [0.5, 0.1]}]
    nlos_blocks: {law: exponential, low_m: 0.5, high_m: 2, mean_m: 1}
)";

/// A scenario in a folder of its own beside its vehicle.
class ScenarioYaml : public ::testing::Test {
 protected:
  ScenarioYaml() { folder_.write("cart.yaml", kVehicle); }

  sim::Scenario load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return loadScenario(folder_.write("try.yaml", text), overrides, "/share");
  }
  Complaint refusal(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return complaintOf([&] { return load(text, overrides); });
  }
  static std::string replaced(std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
  }

  ScratchFolder folder_;
};

TEST_F(ScenarioYaml, KeysReachTheirMembersInSiUnits) {
  const sim::Scenario scenario = load(kScenario);
  EXPECT_EQ(scenario.map, folder_.path().parent_path() / "maps/hall/map.yaml");
  EXPECT_EQ(scenario.vehicle.wheel_radius, 0.11) << "the scenario goes before the vehicle's file";
  EXPECT_EQ(scenario.vehicle.encoder_track, 0.4);
  const auto& motion = std::get<sim::SegmentMotionConfig>(scenario.motion);
  EXPECT_DOUBLE_EQ(motion.start.heading, radians(90.0));
  EXPECT_EQ(motion.segments[1].turn.blend, sim::Blend::Trapezoid);
  EXPECT_EQ(motion.segments[0].drive.speed_to, 1.0);
  const auto& imu = std::get<sim::ImuModel>(scenario.sensors[0].model);
  EXPECT_TRUE(imu.errors.gyro.bias.isApprox(radians(1.0) / 3600.0 * Eigen::Vector3d(1, 2, 3), 1e-14));
  EXPECT_EQ(imu.errors.gyro.noise_density, sim::navigationGrade().gyro.noise_density);
  EXPECT_EQ(imu.errors.accelerometer, sim::navigationGrade().accelerometer);
  const auto& uwb = std::get<sim::UwbConfig>(scenario.sensors[1].model);
  EXPECT_EQ(uwb.tags[0].mount, "roof");
  EXPECT_EQ(uwb.zones[0].sigma.last, 0.1);
  EXPECT_EQ(uwb.zones[0].where.time->to, 2.0);
  ASSERT_TRUE(uwb.errors.blocks);
  EXPECT_EQ(uwb.errors.blocks->bias.kind, sim::BiasLaw::Kind::Exponential);
}

TEST_F(ScenarioYaml, WhatIsWrittenReadsBackToTheSame) {
  const std::string once = resolvedYaml(load(kScenario));
  EXPECT_EQ(resolvedYaml(scenarioFrom(parseYaml(once, "/elsewhere/run.yaml"), "/share")), once);
  EXPECT_THAT(once, HasSubstr("bias_deg_per_h"));
  EXPECT_EQ(once.find("vehicle_file"), std::string::npos) << "the vehicle is spelt out";
}

TEST_F(ScenarioYaml, OverridesReachSensorsByName) {
  const sim::Scenario scenario = load(kScenario, {"sensors.uwb.sigma_m=0.3", "duration_s=2"});
  EXPECT_EQ(std::get<sim::UwbConfig>(scenario.sensors[1].model).sigma, 0.3);
  EXPECT_EQ(scenario.duration, 2.0);
  EXPECT_THAT(refusal(kScenario, {"sensors.uwb.sigm_m=0.3"}).suggestion, HasSubstr("did you mean sigma_m?"));
}

TEST_F(ScenarioYaml, AWrongKeyIsToldWithItsPlaceAndTheRightOne) {
  const Complaint unit = refusal(replaced(kScenario, "by_deg", "by_rad"));
  EXPECT_EQ(unit.place.line, 11);
  EXPECT_EQ(unit.key, "motion.segments[1].turn.by_rad");
  EXPECT_THAT(unit.suggestion, HasSubstr("use by_deg"));
  const Complaint type = refusal(replaced(kScenario, "type: uwb", "type: uvb"));
  EXPECT_EQ(type.key, "sensors[1].type");
  EXPECT_THAT(type.suggestion, HasSubstr("uwb"));
  const Complaint list = refusal(replaced(kScenario, "[1, 2, 3]", "[1, 2]"));
  EXPECT_THAT(list.expected, HasSubstr("a list of 3 numbers in deg/h"));
  EXPECT_THAT(refusal(replaced(kScenario, "[1, 2, 3]", "[1, 2, x]")).key, HasSubstr("bias_deg_per_h[2]"));
}

TEST_F(ScenarioYaml, AFaultInTheVehicleFileIsToldThere) {
  folder_.write("cart.yaml", replaced(kVehicle, "width_m: 0.5", "widht_m: 0.5"));
  const Complaint complaint = refusal(kScenario);
  EXPECT_THAT(complaint.place.file, HasSubstr("cart.yaml"));
  EXPECT_EQ(complaint.place.line, 5);
  EXPECT_THAT(complaint.suggestion, HasSubstr("width_m"));
  folder_.write("cart.yaml", replaced(kVehicle, "schema: 1", "schema: 2"));
  EXPECT_EQ(refusal(kScenario).key, "schema");
  const Complaint missing = refusal(replaced(kScenario, "cart.yaml", "kart.yaml"));
  EXPECT_EQ(missing.place.line, 4);
  EXPECT_THAT(missing.suggestion, HasSubstr("cart.yaml"));
}

TEST_F(ScenarioYaml, SensorsMustHaveNamesOfTheirOwnAndPlacesThatExist) {
  EXPECT_EQ(refusal(replaced(kScenario, "name: uwb", "name: imu")).key, "sensors[1].name");
  EXPECT_THAT(refusal(replaced(kScenario, "mount: roof, grade", "mount: rof, grade")).key,
              HasSubstr("sensors[0]"));
  EXPECT_THAT(refusal(replaced(kScenario, "{id: 3, mount: roof}", "{id: 3, mount: floor}")).key,
              HasSubstr("sensors[1]"));
}

TEST_F(ScenarioYaml, AnUndrivableMotionIsRefusedWhenRead) {
  const Complaint complaint = refusal(replaced(kScenario, "ramp_s: 0.5", "ramp_s: 2"));
  EXPECT_THAT(complaint.key, HasSubstr("motion"));
  EXPECT_THAT(complaint.place.file, HasSubstr("try.yaml"));
}

}  // namespace
}  // namespace pos::io
