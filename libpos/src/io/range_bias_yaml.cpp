#include "pos/io/range_bias_yaml.hpp"

#include "pos/core/error.hpp"
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
              "How far left of the body's x axis the course lies when driving straight.")
      .number("acceleration_density_m_per_s_per_sqrt_s", &CalibratedMotion::acceleration_density,
              between(0, 1000), "How fast the speed wandered.")
      .number("yaw_acceleration_density_deg_per_s_per_sqrt_s", &CalibratedMotion::yaw_acceleration_density,
              between(0, 10000), "How fast the yaw rate wandered.");
}

OptionTable<CalibratedErrors> errorOptions() {
  return OptionTable<CalibratedErrors>("errors", "What the ranges scatter by about the biases.")
      .number("range_sigma_m", &CalibratedErrors::range_sigma, between(0, 100), "New in every reading.")
      .number("lasting_sigma_m", &CalibratedErrors::lasting_sigma, between(0, 100),
              "Shared by readings that follow each other.")
      .number("lasting_time_s", &CalibratedErrors::lasting_time, between(0, 86400),
              "How long that lasts; 0 means longer than the record.");
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
      .table("errors", &RangeBiasTable::errors, errorOptions(),
             "What the ranges scatter by about the biases.")
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
  config.range_biases.clear();
  for (const CalibratedLink& link : table.links) config.range_biases.push_back(link.link);
  config.tag_shifts = table.tag_shifts;
  if (table.motion) {
    if (config.motion_centre_x != 0.0 || config.course_offset != 0.0) {
      throw ConfigError(Complaint{.what = "the vehicle's motion is given twice",
                                  .key = "range_bias_table",
                                  .got = "a table with motion, beside motion_centre_x_m or course_offset_deg",
                                  .suggestion = "remove the two keys, or motion from the table"});
    }
    config.motion_centre_x = table.motion->centre_x;
    config.course_offset = table.motion->course_offset;
  }
  config.range_bias_table.clear();
  return config;
}

}  // namespace pos::io
