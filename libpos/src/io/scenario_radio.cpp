/// Option tables of radio ranging.
#include "scenario_options.hpp"

namespace pos::io {
namespace {

using namespace pos::sim;

/// The keys of a law that `law` gives.
template <class T, class Member>
OptionTable<T>& withLaw(OptionTable<T>& table, Member law) {
  return table
      .choice(
          "law", [law](auto& s) -> auto& { return std::invoke(law, s).kind; },
          {{"uniform", BiasLaw::Kind::Uniform}, {"exponential", BiasLaw::Kind::Exponential}},
          "From which law a size is drawn.")
      .number(
          "low_m", [law](auto& s) -> auto& { return std::invoke(law, s).low; }, anything(), "Smallest.")
      .number(
          "high_m", [law](auto& s) -> auto& { return std::invoke(law, s).high; }, anything(), "Largest.")
      .number(
          "mean_m", [law](auto& s) -> auto& { return std::invoke(law, s).mean; }, atLeast(0),
          "Mean above the smallest, for exponential.");
}

OptionTable<LinkError> linkOptions() {
  return OptionTable<LinkError>("links", "Scale and offset of some links.")
      .integer("tag", &LinkError::tag, anything(), "The tag; all where absent.")
      .integer("anchor", &LinkError::anchor, anything(), "The anchor; all where absent.")
      .number("scale", &LinkError::scale, between(-0.5, 0.5), "Measured = (1 + scale) true + offset.")
      .number("offset_m", &LinkError::offset, between(-1000, 1000), "Added to the true range.");
}

OptionTable<LinkSpread> spreadOptions() {
  return OptionTable<LinkSpread>("link_spread", "Scale and offset drawn once a run and link.")
      .number("scale_low", &LinkSpread::scale_low, between(-0.5, 0.5), "Smallest scale.")
      .number("scale_high", &LinkSpread::scale_high, between(-0.5, 0.5), "Largest scale.")
      .number("offset_low_m", &LinkSpread::offset_low, between(-1000, 1000), "Smallest offset.")
      .number("offset_high_m", &LinkSpread::offset_high, between(-1000, 1000), "Largest offset.");
}

OptionTable<Multipath> multipathOptions() {
  OptionTable<Multipath> table("multipath", "Single ranges that took a way round.");
  table.number("probability", &Multipath::probability, between(0, 1), "Of each range.");
  return withLaw(table, &Multipath::excess);
}

OptionTable<Outliers> outlierOptions() {
  OptionTable<Outliers> table("outliers", "Gross errors of both signs.");
  table.number("probability", &Outliers::probability, between(0, 1), "Of each range.")
      .number("short_share", &Outliers::short_share, between(0, 1), "Share of them that is too short.");
  return withLaw(table, &Outliers::size);
}

OptionTable<NlosProcess> processOptions() {
  OptionTable<NlosProcess> table("nlos_process", "Anchors hidden by passing traffic: a two-state process.");
  table.number("mean_free_s", &NlosProcess::mean_free, moreThan(0), "Mean free spell.")
      .number("mean_hidden_s", &NlosProcess::mean_hidden, moreThan(0), "Mean hidden spell.");
  return withLaw(table, &NlosProcess::bias);
}

OptionTable<NlosBlocks> blockOptions() {
  OptionTable<NlosBlocks> table("nlos_blocks", "Anchors hidden anew in every block of time.");
  table.number("probability", &NlosBlocks::probability, between(0, 1), "Of each anchor and block.")
      .number("period_s", &NlosBlocks::period, moreThan(0), "Length of a block.");
  return withLaw(table, &NlosBlocks::bias);
}

OptionTable<NlosEpisode> episodeOptions() {
  OptionTable<NlosEpisode> table("nlos_episodes", "One anchor hidden for a while.");
  table.integer("anchor", &NlosEpisode::anchor, anything(), "Its number.")
      .required()
      .table("time", &NlosEpisode::when, spanOptions("time", "When."), "When.")
      .required();
  return withLaw(table, &NlosEpisode::bias);
}

OptionTable<AnchorSilence> silenceOptions() {
  return OptionTable<AnchorSilence>("silences", "One anchor not heard for a while.")
      .integer("anchor", &AnchorSilence::anchor, anything(), "Its number.")
      .required()
      .integer("tag", &AnchorSilence::tag, anything(), "The tag that does not hear it; all where absent.")
      .table("time", &AnchorSilence::when, spanOptions("time", "When."), "When.")
      .required();
}

OptionTable<Obstruction> obstructionOptions() {
  OptionTable<Obstruction> table("obstruction", "What becomes of a range through rock.");
  table.choice("effect", &Obstruction::effect,
               {{"lost", Obstruction::Effect::Lost}, {"delayed", Obstruction::Effect::Delayed}},
               "Whether it is not heard, or comes too long.");
  return withLaw(table, &Obstruction::bias);
}

OptionTable<RadioPower> powerOptions() {
  return OptionTable<RadioPower>("power", "Received power by distance.")
      .number("power_at_1m_dbm", &RadioPower::power_at_1m, anything(), "At one metre.")
      .number("exponent", &RadioPower::exponent, between(0.1, 10), "Path loss exponent.")
      .number("first_path_gap_db", &RadioPower::first_path_gap, atLeast(0), "First path below the total.")
      .number("hidden_loss_db", &RadioPower::hidden_loss, atLeast(0), "Loss of a hidden link.")
      .number("hidden_first_path_loss_db", &RadioPower::hidden_first_path_loss, atLeast(0),
              "Further loss of its first path.")
      .number("sigma_db", &RadioPower::sigma, atLeast(0), "Noise.");
}

OptionTable<TwoWayConfig> twoWayOptions() {
  return OptionTable<TwoWayConfig>("two_way", "The exchange of six time stamps, for mode two_way.")
      .number("tick_s", &TwoWayConfig::tick, moreThan(0), "Of the radio's clock per count.")
      .integer("counter_bits", &TwoWayConfig::counter_bits, between(8, 62), "The counter wraps at 2^bits.")
      .number("reply_responder_s", &TwoWayConfig::reply_responder, moreThan(0), "Of the anchor.")
      .number("reply_initiator_s", &TwoWayConfig::reply_initiator, moreThan(0), "Of the tag.")
      .number("receive_jitter_s", &TwoWayConfig::receive_jitter, atLeast(0), "Of each receive stamp.");
}

OptionTable<RadioDevices> deviceOptions() {
  return OptionTable<RadioDevices>("devices", "Spread of the radios, for mode two_way.")
      .number("rate_error_max_ppm", &RadioDevices::rate_error_max, atLeast(0),
              "Clock rates lie within plus and minus this.")
      .number("antenna_delay_s", &RadioDevices::antenna_delay, atLeast(0), "Each way, as calibrated.")
      .number("antenna_delay_sigma_s", &RadioDevices::antenna_delay_sigma, atLeast(0),
              "What calibration left over.");
}

OptionTable<Tag> tagOptions() {
  OptionTable<Tag> table("tags", "A tag on the vehicle.");
  table.integer("id", &Tag::id, anything(), "The radio's own number of the tag.")
      .required()
      .text("mount", &Tag::mount, "Name of its place on the vehicle, instead of coordinates.");
  addPlace(table, &Tag::tag_body, "Where it sits,");
  return table.number("delay_s", &Tag::delay, atLeast(0), "After the beat at which its cycle begins.");
}

OptionTable<RangeZone> rangeZoneOptions() {
  OptionTable<RangeZone> table("zones", "Where ranges have another noise; the first that holds counts.");
  return withZone(table).flag("silent", &RangeZone::silent, "Whether there are no ranges at all.");
}

}  // namespace

OptionTable<UwbConfig> uwbOptions() {
  OptionTable<UwbConfig> table("uwb", "Radio ranges between tags and the map's anchors.");
  addTiming(table, &UwbConfig::timing);
  return table.list("tags", &UwbConfig::tags, tagOptions(), "Tags on the vehicle.")
      .required()
      .choice("mode", &UwbConfig::mode,
              {{"two_way", RangeMode::TwoWay},
               {"gaussian", RangeMode::Gaussian},
               {"tag_noise", RangeMode::TagNoise},
               {"tag_position", RangeMode::TagPosition}},
              "Six stamps of two clocks; noise on the range; noise on the tag's place, given as ranges or as "
              "the place itself.")
      .number("sigma_m", &UwbConfig::sigma, between(0, 100), "Noise of a range, or of each axis of a tag.")
      .number("sigma_z_m", &UwbConfig::sigma_z, between(0, 100), "Noise of a tag's height.")
      .choice(
          "schedule", [](auto& u) -> auto& { return u.schedule.kind; },
          {{"simultaneous", RangeSchedule::Kind::Simultaneous},
           {"sequential", RangeSchedule::Kind::Sequential}},
          "All links at once, or one a slot.")
      .number(
          "slot_s", [](auto& u) -> auto& { return u.schedule.slot; }, moreThan(0), "Length of a slot.")
      .list("zones", &UwbConfig::zones, rangeZoneOptions(), "Where ranges have another noise.")
      .table("two_way", &UwbConfig::two_way, twoWayOptions(), "The exchange, for mode two_way.")
      .table("devices", &UwbConfig::devices, deviceOptions(), "Spread of the radios, for mode two_way.")
      .number(
          "drop_probability", [](auto& u) -> auto& { return u.errors.drop_probability; }, between(0, 1),
          "Of any single range.")
      .list(
          "links", [](auto& u) -> auto& { return u.errors.links; }, linkOptions(),
          "Scale and offset of some links.")
      .table(
          "link_spread", [](auto& u) -> auto& { return u.errors.spread; }, spreadOptions(),
          "Scale and offset drawn once a run and link.")
      .table(
          "multipath", [](auto& u) -> auto& { return u.errors.multipath; }, multipathOptions(),
          "Single ranges that took a way round.")
      .table(
          "outliers", [](auto& u) -> auto& { return u.errors.outliers; }, outlierOptions(),
          "Gross errors of both signs.")
      .table(
          "nlos_process", [](auto& u) -> auto& { return u.errors.process; }, processOptions(),
          "Anchors hidden by passing traffic.")
      .table(
          "nlos_blocks", [](auto& u) -> auto& { return u.errors.blocks; }, blockOptions(),
          "Anchors hidden anew in every block of time.")
      .list(
          "nlos_episodes", [](auto& u) -> auto& { return u.errors.episodes; }, episodeOptions(),
          "Anchors hidden for a while.")
      .table(
          "obstruction", [](auto& u) -> auto& { return u.errors.obstruction; }, obstructionOptions(),
          "What becomes of a range through rock.")
      .list(
          "silences", [](auto& u) -> auto& { return u.errors.silences; }, silenceOptions(),
          "Anchors not heard for a while.")
      .number("range_max_m", &UwbConfig::range_max, moreThan(0), "Longest true distance.")
      .number("survey_error", &UwbConfig::survey_error, between(0, 10),
              "Anchors truly stand this many of their survey_sigma_m beside their place, by chance.")
      .table("power", &UwbConfig::power, powerOptions(), "Received power; not reported where absent.")
      .number("claimed_sigma_m", &UwbConfig::claimed_sigma, moreThan(0),
              "What ranges say of their noise; nothing where absent.")
      .flag("report_tag_body", &UwbConfig::report_tag_body, "Whether ranges tell where their tag sits.");
}

}  // namespace pos::io
