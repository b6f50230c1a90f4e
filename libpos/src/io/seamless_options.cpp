#include "pos/io/seamless_options.hpp"

#include "pos/io/estimator_options.hpp"
#include "pos/io/sins_options.hpp"
#include "pos/io/uwb_imu_options.hpp"

namespace pos::io {
namespace {

using estimation::GnssUse;
using estimation::InteractionConfig;
using estimation::SeamlessAids;
using estimation::SeamlessConfig;
using estimation::SeamlessMounts;
using estimation::UwbUse;
using filters::FuzzyConfig;
using filters::FuzzyVariant;
using filters::LikelihoodForm;

constexpr auto kValid = [](const auto& config) { return validated(config); };

OptionTable<Eigen::Vector3d> placeOptions(const std::string& title) {
  return OptionTable<Eigen::Vector3d>(title, "A place on the body.")
      .number(
          "x_m", [](auto& p) -> auto& { return p.x(); }, between(-100, 100), "Forward of the body frame.")
      .number(
          "y_m", [](auto& p) -> auto& { return p.y(); }, between(-100, 100), "Left of the body frame.")
      .number(
          "z_m", [](auto& p) -> auto& { return p.z(); }, between(-100, 100), "Above the body frame.");
}

OptionTable<SeamlessMounts> mountOptions() {
  return OptionTable<SeamlessMounts>("mounts", "Where things sit on the body.")
      .table("imu", &SeamlessMounts::imu, placeOptions("imu"), "The inertial unit; its axes are the body's.")
      .table("gnss", &SeamlessMounts::gnss, placeOptions("gnss"), "The antenna for satellites.")
      .table("axle", &SeamlessMounts::axle, placeOptions("axle"),
             "The middle of the axle that does not steer.")
      .list("tags", &SeamlessMounts::tags, tagOptions(), "Tags; others sit where the log says.");
}

OptionTable<GnssUse> gnssOptions() {
  using Surprise = GnssUse::Surprise;
  using Mask = GnssUse::Mask;
  return OptionTable<GnssUse>("gnss", "Satellites.")
      .choice(
          "surprise", &GnssUse::surprise,
          {{"believe", Surprise::Believe}, {"gate", Surprise::Gate}, {"adapt", Surprise::Adapt}},
          "A fix that is not expected is good, is left out, or is worse than it claims, and so are the next.")
      .choice("mask", &GnssUse::mask,
              {{"automatic", Mask::Automatic}, {"off", Mask::Off}, {"always", Mask::Always}},
              "Whether satellites are left out: under ground by the map's portals, never, or everywhere.")
      .number("confidence", &GnssUse::confidence, between(0.5, 0.999999),
              "A fix further off than this share of honest ones is not expected.")
      .number("adapt_time_s", &GnssUse::adapt_time, moreThan(0),
              "How fast trust comes back after such a fix, with `adapt`.")
      .number("sigma_max_m", &GnssUse::sigma_max, moreThan(0), "A fix that claims to be worse is left out.")
      .number("mask_margin_m", &GnssUse::mask_margin, between(0, 1000),
              "So far beyond the hand-over zone it is dark.")
      .check(kValid);
}

OptionTable<UwbUse> uwbOptions() {
  return OptionTable<UwbUse>("uwb", "Radio ranges.")
      .number("sigma_m", &UwbUse::sigma, moreThan(0), "Standard deviation of a range in sight.")
      .table("robust", &UwbUse::robust, robustOptions(), "How far a range that surprises is believed.")
      .number("adapt_count", &UwbUse::adapt_count, between(0, 1e6),
              "Ranges too short over which it is learnt how much worse they are than sigma_m; 0: it is not.")
      .table("anchor_bias", &UwbUse::anchor_bias, anchorBiasOptions(),
             "Offsets of anchors that keep surprising, as states.")
      .flag("masked", &UwbUse::masked, "Leaves the radio out everywhere.")
      .check(kValid);
}

OptionTable<InteractionConfig> immOptions() {
  using Config = InteractionConfig;
  return OptionTable<Config>("imm", "How the two filters interact.")
      .number("stay", &Config::stay, between(0.5, 1), "Probability that the mode is the same a period later.")
      .number("period_s", &Config::period, moreThan(0), "That period.")
      .number("first_gnss", &Config::first_gnss, between(0, 1),
              "Probability of the satellites' mode at the start.")
      .number("floor", &Config::floor, between(0, 0.5), "No probability falls below.")
      .number("usable_floor", &Config::usable_floor, between(0, 0.5), "Nor that of a mode in use below this.")
      .choice("likelihood", &Config::likelihood,
              {{"normalised", LikelihoodForm::Normalised},
               {"raw", LikelihoodForm::Raw},
               {"position_domain", LikelihoodForm::PositionDomain}},
              "Per number measured, as it is, or of the place the ranges amount to.")
      .number("overdue_s", &Config::overdue, between(0, 60), "So long after a reading was due it is missing.")
      .integer("rejected_in_a_row", &Config::rejected_in_a_row, between(1, 1000000),
               "After so many epochs of nothing but rejected readings a mode is not usable.")
      .number("recover_after_s", &Config::recover_after, moreThan(0),
              "After so long without a usable mode the state is made uncertain.")
      .number("rejoin_inflation", &Config::rejoin_inflation, between(1, 1e6),
              "Factor on the covariance that a mode comes back with.")
      .check(kValid);
}

OptionTable<FuzzyConfig> fuzzyOptions() {
  return OptionTable<FuzzyConfig>("fuzzy", "The fuzzy controller.")
      .choice("variant", &FuzzyConfig::variant,
              {{"paper", FuzzyVariant::Paper},
               {"paper_sym", FuzzyVariant::PaperSym},
               {"centroid", FuzzyVariant::Centroid},
               {"incremental", FuzzyVariant::Incremental}},
              "As printed, with the symmetric table, with the centroid, or as a correction of Bayes' rule.")
      .number("gain", &FuzzyConfig::gain, between(0, 0.6), "Of that correction.")
      .check(kValid);
}

OptionTable<SeamlessAids> aidOptions() {
  return OptionTable<SeamlessAids>("aids", "What else is known of vehicle and mine.")
      .number("side_slip_sigma_m_per_s", &SeamlessAids::side_slip_sigma, between(0, 10),
              "Sideways and upward speed of the axle; 0: not used.")
      .number("floor_sigma_m", &SeamlessAids::floor_sigma, between(0, 100),
              "Height over the map's floor; 0: not used.")
      .number("interval_s", &SeamlessAids::interval, moreThan(0), "Time between them.")
      .check(kValid);
}

}  // namespace

OptionTable<SeamlessConfig> seamlessOptions() {
  using Config = SeamlessConfig;
  return OptionTable<Config>("seamless", "Satellites on the surface, radio under ground, one inertial unit.")
      .choice("variant", &Config::variant, {{"imm", Config::Variant::Imm}, {"faimm", Config::Variant::Faimm}},
              "Interacting models by Bayes' rule, or with the fuzzy controller.")
      .table("start", &Config::start, startOptions(), "Position and heading at the first measurement.")
      .number("height_m", &Config::height, between(-10000, 10000), "Height of the body frame at the start.")
      .number("height_sigma_m", &Config::height_sigma, moreThan(0), "How sure that is.")
      .number("velocity_sigma_m_per_s", &Config::velocity_sigma, moreThan(0), "How still it stands then.")
      .table("imu", &Config::imu, imuNoiseOptions(), "What the inertial unit does wrong.")
      .table("alignment", &Config::alignment, alignmentOptions(), "Standing still before the first answer.")
      .table("standstill", &Config::standstill, standstillOptions(), "How standing is told.")
      .table("mounts", &Config::mounts, mountOptions(), "Where things sit on the body.")
      .table("gnss", &Config::gnss, gnssOptions(), "Satellites.")
      .table("uwb", &Config::uwb, uwbOptions(), "Radio ranges.")
      .table("imm", &Config::imm, immOptions(), "How the two filters interact.")
      .table("fuzzy", &Config::fuzzy, fuzzyOptions(), "The fuzzy controller, with variant: faimm.")
      .table("aids", &Config::aids, aidOptions(), "What else is known of vehicle and mine.")
      .check(kValid);
}

}  // namespace pos::io
