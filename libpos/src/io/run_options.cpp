// How the configuration of a replay is spelt.
#include "run_rules.hpp"

namespace pos::io {
namespace {

using Align = EvaluationConfig::Align;
using Format = TruthSource::Format;

OptionTable<TruthSource> truthOptions() {
  return OptionTable<TruthSource>("truth", "Reference poses for the evaluation.")
      .path("file", &TruthSource::file, "File of the reference poses; none for format: log.")
      .choice("format", &TruthSource::format,
              {{"tum", Format::Tum},
               {"euroc", Format::Euroc},
               {"mrpt_index", Format::MrptIndex},
               {"log", Format::Log}},
              "How the file is written; mrpt_index has one row a frame, log takes the poses in the log.")
      .number(
          "x_m", [](auto& truth) -> auto& { return truth.T_map_truth.x; }, anything(),
          "Put in front of every reference pose: east in the map.")
      .number(
          "y_m", [](auto& truth) -> auto& { return truth.T_map_truth.y; }, anything(),
          "Put in front of every reference pose: north in the map.")
      .number(
          "yaw_deg", [](auto& truth) -> auto& { return truth.T_map_truth.yaw; }, between(-360, 360),
          "Put in front of every reference pose: heading, counter-clockwise.")
      .check(requireTruthFile);
}

OptionTable<FaultConfig> faultOptions() {
  return OptionTable<FaultConfig>("faults", "Damage done to the log on purpose.")
      .number("range_outlier_probability", &FaultConfig::range_outlier_probability, between(0, 1),
              "Share of the ranges that are lengthened.")
      .number("range_outlier_min_m", &FaultConfig::range_outlier_min, between(-1000, 1000),
              "Least that is added to such a range.")
      .number("range_outlier_max_m", &FaultConfig::range_outlier_max, between(-1000, 1000),
              "Most that is added to such a range.")
      .integer("seed", &FaultConfig::seed, atLeast(0), "Seed of the faults; the run's seed where absent.")
      .check(requireOrder);
}

OptionTable<SensorConfig> sensorOptions() {
  return OptionTable<SensorConfig>("sensors", "What to know of one sensor of the log.")
      .text("sensor", &SensorConfig::sensor, "Label of the sensor in the log.")
      .required()
      .flag("use", &SensorConfig::use, "Whether its measurements are used.")
      .number("latency_s", &SensorConfig::latency, between(-60, 60),
              "Its stamps are this late; they are moved back by it.");
}

OptionTable<WindowConfig> windowOptions() {
  return OptionTable<WindowConfig>("windows", "A stretch of the run whose errors are also given alone.")
      .text("name", &WindowConfig::name,
            "Name of its figures: letters, digits, _ and - only. Windows of one name are taken together.")
      .required()
      .number("from_s", &WindowConfig::from, between(0, 1e7), "Its beginning, from the start of the truth.")
      .number("to_s", &WindowConfig::to, between(0, 1e7), "Its end.")
      .required()
      .check(requireWindow);
}

OptionTable<EvaluationConfig> evaluationOptions() {
  return OptionTable<EvaluationConfig>("evaluation", "How estimates are compared with the truth.")
      .choice("align", &EvaluationConfig::align,
              {{"none", Align::None},
               {"origin", Align::Origin},
               {"se2", Align::Se2},
               {"se3", Align::Se3},
               {"posyaw", Align::PosYaw}},
              "How the estimate is moved onto the truth first; moving hides errors of map and anchors.")
      .number("skip_start_s", &EvaluationConfig::skip_start, between(0, 86400),
              "Time not judged at the beginning.")
      .number("max_gap_s", &EvaluationConfig::max_gap, between(0.001, 3600),
              "The truth is not interpolated over a longer gap.")
      .number("truth_time_offset_s", &EvaluationConfig::truth_time_offset, anything(),
              "Added to the stamps of the truth.")
      .number("truth_sigma_m", &EvaluationConfig::truth_sigma, between(0, 1000),
              "How good the truth is, per axis; added to the claimed covariance for the NEES only.")
      .list("windows", &EvaluationConfig::windows, windowOptions(),
            "Stretches of the run whose errors are also given alone.");
}

OptionTable<LogSource> logOptions() {
  return OptionTable<LogSource>("log", "The recording to replay.")
      .path("file", &LogSource::file,
            "The recording; mrpt-common: stands for the share folder of that package.")
      .required();
}

OptionTable<ScenarioSource> scenarioSourceOptions() {
  return OptionTable<ScenarioSource>("scenario", "A simulation in the place of a recording.")
      .path("file", &ScenarioSource::file, "The scenario; it brings its own map and truth.")
      .required()
      .number("truth_rate_hz", &ScenarioSource::truth_rate, between(0.001, 10000),
              "Reference poses per second for the evaluation.")
      .number("duration_s", &ScenarioSource::duration, moreThan(0),
              "Only so much of the scenario; all of it where absent.");
}

OptionTable<CampaignConfig> campaignOptions() {
  return OptionTable<CampaignConfig>("campaign", "How many runs are taken together by `pos campaign`.")
      .number("step_s", &CampaignConfig::step, between(0.0001, 86400),
              "Time between the moments at which the runs are compared; 1 / record.max_rate_hz where absent.")
      .text("baseline", &CampaignConfig::baseline,
            "Name of the estimator that the others are compared with; the first where absent.");
}

}  // namespace

OptionTable<RunConfig> runOptions() {
  return OptionTable<RunConfig>("Replay configuration", "Which log is replayed through which estimators.")
      .integer("schema", &RunConfig::schema, between(1, 1), "Version of this format.")
      .required()
      .text("name", &RunConfig::name, "Name of the run in reports.")
      .required()
      .table("log", &RunConfig::log, logOptions(), "The recording to replay, unless --log names it.")
      .table("scenario", &RunConfig::scenario, scenarioSourceOptions(),
             "A simulation in the place of a recording; the seed of the run is its seed.")
      .path("map", &RunConfig::map, "The map file, unless --map names it; a scenario's own map where absent.")
      .table("truth", &RunConfig::truth, truthOptions(),
             "Reference poses for the evaluation, unless --truth names them.")
      .table(
          "sequencer", &RunConfig::sequencer,
          OptionTable<SequencerConfig>("sequencer", "Puts the measurements of all sensors in order of time.")
              .number("lag_s", &SequencerConfig::lag, between(0, 3600),
                      "How late a measurement may come and still be put in order."),
          "Puts the measurements of all sensors in order of time.")
      .integer("seed", &RunConfig::seed, atLeast(0), "Seed of all random numbers of the run.")
      .table("record", &RunConfig::record,
             OptionTable<RecordConfig>("record", "What is written while running.")
                 .number("max_rate_hz", &RecordConfig::max_rate, between(0.001, 100000),
                         "Estimates written per second and estimator at most."),
             "What is written while running.")
      .table("faults", &RunConfig::faults, faultOptions(), "Damage done to the log on purpose.")
      .list("sensors", &RunConfig::sensors, sensorOptions(),
            "What to know of single sensors; others are used as they are.")
      .table("evaluation", &RunConfig::evaluation, evaluationOptions(),
             "How estimates are compared with the truth.")
      .table("campaign", &RunConfig::campaign, campaignOptions(),
             "How many runs are taken together by `pos campaign`.")
      .table("intervals", &RunConfig::intervals, intervalsOptions(),
             "In which lock interval of the map's roadways the vehicle is; not evaluated where absent.")
      .list("estimators", &RunConfig::estimators, estimatorOptions(), "The estimators to run side by side.")
      .required()
      .check(requireWhole);
}

}  // namespace pos::io
