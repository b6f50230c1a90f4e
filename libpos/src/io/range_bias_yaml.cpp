#include "pos/io/range_bias_yaml.hpp"

#include "pos/io/estimator_options.hpp"

namespace pos::io {
namespace {

OptionTable<CalibratedLink> linkOptions() {
  return OptionTable<CalibratedLink>("link",
                                     "What one tag and one anchor read too long, and how sure that is.")
      .integer(
          "tag", [](auto& link) -> auto& { return link.link.tag; }, anything(),
          "The radio's own number of the tag.")
      .required()
      .integer(
          "anchor", [](auto& link) -> auto& { return link.link.anchor; }, anything(),
          "The radio's own number of the anchor.")
      .required()
      .number(
          "bias_m", [](auto& link) -> auto& { return link.link.bias; }, between(-100, 100),
          "Subtracted from every range of the link.")
      .required()
      .number("bias_sigma_m", &CalibratedLink::bias_sigma, between(0, 100), "How sure the bias is.")
      .number("residual_sigma_m", &CalibratedLink::residual_sigma, between(0, 100),
              "Standard deviation of the ranges about it.")
      .integer("samples", &CalibratedLink::samples, atLeast(0), "Ranges used.")
      .integer("outliers", &CalibratedLink::outliers, atLeast(0), "Ranges left out.");
}

OptionTable<CalibratedMotion> motionOptions() {
  return OptionTable<CalibratedMotion>("motion", "How the body frame lies in the vehicle's motion.")
      .number("centre_x_m", &CalibratedMotion::centre_x, between(-100, 100),
              "How far the body frame lies ahead of the point that the vehicle turns about.")
      .number("course_offset_deg", &CalibratedMotion::course_offset, between(-180, 180),
              "How far left of the body's x axis the course lies when driving straight.");
}

}  // namespace

OptionTable<RangeBiasTable> rangeBiasOptions() {
  return OptionTable<RangeBiasTable>("Range biases", "What every link reads too long.")
      .integer("schema", &RangeBiasTable::schema, between(1, 1), "Version of this format.")
      .required()
      .text("source", &RangeBiasTable::source, "What the table was made from.")
      .list("links", &RangeBiasTable::links, linkOptions(), "One entry for each tag and anchor.")
      .required()
      .list("tag_shifts", &RangeBiasTable::tag_shifts, tagShiftOptions(),
            "How far the tags' electrical places lie from their mounts.")
      .table("motion", &RangeBiasTable::motion, motionOptions(),
             "How the body frame lies in the vehicle's motion; absent where the poses hardly moved.");
}

RangeBiasTable loadRangeBiasTable(const std::filesystem::path& file) {
  return readOptions(loadYaml(file), rangeBiasOptions());
}

std::string rangeBiasYaml(const RangeBiasTable& table) {
  return optionsYaml(table, rangeBiasOptions());
}

estimation::DualUwbConfig withTable(estimation::DualUwbConfig config, const RangeBiasTable& table) {
  config.range_offset = 0.0;  // the table's biases hold all that a link reads too long
  config.range_biases.clear();
  for (const CalibratedLink& link : table.links) config.range_biases.push_back(link.link);
  config.tag_shifts = table.tag_shifts;
  if (table.motion) {
    config.motion_centre_x = table.motion->centre_x;
    config.course_offset = table.motion->course_offset;
  }
  config.range_bias_table.clear();
  return config;
}

}  // namespace pos::io
