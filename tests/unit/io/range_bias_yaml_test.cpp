#include "pos/io/range_bias_yaml.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "pos/core/error.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

RangeBiasTable sampleTable() {
  RangeBiasTable table;
  table.source = "log.rawlog";
  table.links = {{{0, 1, 0.125}, 0.01, 0.07, 260, 3}, {{1, 1, -0.05}, 0.02, 0.06, 250, 0}};
  table.tag_shifts = {{0, 0.01, -0.02}};
  table.errors = CalibratedErrors{0.03125, 0.0625, 1.5};
  table.motion = CalibratedMotion{0.0625, 0.0, 0.125, 0.0};
  return table;
}

TEST(RangeBiasYaml, ReadsBackWhatItWrites) {
  const ScratchFolder folder;
  const auto file = folder.path() / "biases.yaml";
  std::ofstream(file) << rangeBiasYaml(sampleTable());
  EXPECT_EQ(loadRangeBiasTable(file), sampleTable());
}

TEST(RangeBiasYaml, FillsTheBiasesOfTheConfiguration) {
  estimation::DualUwbConfig config;
  config.range_bias_table = "biases.yaml";
  const estimation::DualUwbConfig with = withTable(config, sampleTable());
  EXPECT_TRUE(with.range_bias_table.empty());
  ASSERT_EQ(with.range_biases.size(), 2u);
  EXPECT_EQ(with.range_biases[1], (estimation::LinkBias{1, 1, -0.05}));
  EXPECT_EQ(with.tag_shifts.size(), 1u);
  EXPECT_EQ(with.motion_centre_x, 0.0625);
  RangeBiasTable still = sampleTable();
  still.motion.reset();
  config.motion_centre_x = 0.5;
  EXPECT_EQ(withTable(config, still).motion_centre_x, 0.5) << "no motion was calibrated";
  EXPECT_THROW((void)withTable(config, sampleTable()), ConfigError) << "the motion is given twice";
}

TEST(RangeBiasYaml, ATableBesideBiasesOfTheConfigurationIsRefused) {
  estimation::DualUwbConfig config;
  config.range_bias_table = "biases.yaml";
  EXPECT_NO_THROW((void)estimation::validated(config));
  config.range_offset = 0.15;
  EXPECT_THROW((void)estimation::validated(config), ConfigError);
  config.range_offset = 0.0;
  config.range_biases = {{7, 7, 7.0}};
  EXPECT_THROW((void)estimation::validated(config), ConfigError);
}

TEST(RangeBiasYaml, AMistypedKeyIsRefused) {
  const ScratchFolder folder;
  const auto file = folder.path() / "biases.yaml";
  std::ofstream(file) << "schema: 1\nlinks: [{tag: 0, anchor: 1, bias: 0.1}]\n";
  EXPECT_THROW((void)loadRangeBiasTable(file), ConfigError);
}

}  // namespace
}  // namespace pos::io
