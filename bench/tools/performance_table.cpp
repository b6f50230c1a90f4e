#include "performance_table.hpp"

#include <cmath>
#include <cstdio>
#include <regex>
#include <stdexcept>

namespace pos::bench {
namespace {

using nlohmann::json;

/// Three significant digits, without an exponent.
std::string shown(double value) {
  const double size = std::abs(value);
  const int decimals = size >= 100.0 ? 0 : size >= 10.0 ? 1 : 2;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string row(const json& run, const Comparison& c) {
  const double ours = aggregate(run, "median", c.ours, c.counter);
  const double yardstick = aggregate(run, "median", c.yardstick, c.counter);
  const double factor = yardstick / ours;
  std::string line = "| " + c.what + " | " + shown(ours) + ' ' + c.unit + " | " + shown(yardstick) + ' ' +
                     c.unit + " | " + shown(factor) + " | ";
  if (c.least_factor <= 0.0) return line + "- |\n";
  return line + ">= " + shown(c.least_factor) + (factor >= c.least_factor ? ", met" : ", missed") + " |\n";
}

/// Of times the median of the repetitions counts, of memory the most.
std::string table(const json& run, const Topic& topic) {
  std::string text = "### " + topic.title + "\n\n";
  if (!topic.comparisons.empty()) {
    text += "| | ours | " + topic.yardstick + " | times faster | target |\n| --- | --- | --- | --- | --- |\n";
    for (const Comparison& c : topic.comparisons) text += row(run, c);
  }
  if (topic.figures.empty()) return text;
  if (!topic.comparisons.empty()) text += "\n";
  text += "| | |\n| --- | --- |\n";
  for (const Figure& f : topic.figures) {
    const bool memory = f.counter == "memory_growth_kb";
    const double value = aggregate(run, memory ? "max" : "median", f.benchmark, f.counter);
    text += "| " + f.what + " | " + shown(value) + ' ' + f.unit + " |\n";
  }
  return text;
}

Topic particleFilter() {
  const auto row = [](const char* what, const std::string& hot_path, const char* item, double target) {
    const std::size_t size = hot_path.find('/');
    const std::string name = hot_path.substr(0, size);
    const std::string argument = size == std::string::npos ? "" : hot_path.substr(size);
    return Comparison{what, name + "_ours" + argument, name + "_mrpt" + argument, item, "ns", target};
  };
  const auto portable = [](const char* what, const char* benchmark, const char* item) {
    return Figure{what, benchmark, item, "ns"};
  };
  return {
      .title = "Particle filter",
      .yardstick = "MRPT",
      .comparisons = {row("range, per particle and range", "ranges", "ns_per_particle_range", 60.0),
                      row("scan, per particle and beam", "scan", "ns_per_particle_beam", 20.0),
                      row("motion, per particle", "predict", "ns_per_particle", 40.0),
                      row("resampling, per particle", "resample/20000", "ns_per_particle", 0.0),
                      row("resampling a million, per particle", "resample/1000000", "ns_per_particle", 15.0),
                      row("whole step with 4 ranges, per particle", "step_ranges", "ns_per_particle", 25.0),
                      row("whole step with a scan of 152 beams, per particle", "step_scan", "ns_per_particle",
                          20.0)},
      .figures = {portable("range without AVX2 and AVX-512", "ranges_portable", "ns_per_particle_range"),
                  portable("scan without them", "scan_portable", "ns_per_particle_beam"),
                  portable("motion without them", "predict_portable", "ns_per_particle")}};
}

Topic particleThreads() {
  return {.title = "Particle filter with a million particles, by the clock on the wall",
          .yardstick = "one thread",
          .comparisons = {{"two threads: motion, 4 ranges, resampling", "million/2", "million/1", "real_time",
                           "ms", 1.7}},
          .figures = {{"memory with its buffers, per particle", "million/1", "bytes_per_particle", "B"}}};
}

Topic rangeOdometry() {
  Topic topic{.title = "range_odometry", .yardstick = "dense Eigen", .comparisons = {}, .figures = {}};
  const std::vector<std::pair<std::string, std::string>> sizes{
      {"pose", "3 states"}, {"calibrated", "7 states"}, {"anchor_offsets", "23 states"}};
  for (const std::string kind : {"increment", "range"}) {
    for (const auto& [name, size] : sizes) {
      topic.comparisons.push_back({"one " + kind + ", " + size, kind + "_ours/" + name,
                                   kind + "_dense/" + name, "ns_per_" + kind, "ns", 0.0});
    }
  }
  return topic;
}

Topic reading() {
  return {
      .title = "Reading a rawlog",
      .yardstick = "MRPT streaming read",
      .comparisons = {{"1.1 million observations", "read_ours", "read_mrpt", "real_time", "ms", 0.0},
                      {"the same from its packed copy", "read_copy", "read_mrpt", "real_time", "ms", 0.0}},
      .figures = {{"growth of the peak memory", "read_ours", "memory_growth_kb", "kB"}}};
}

Topic replay() {
  return {.title = "Replay: reading, ordering, filtering, estimates (time on the clock)",
          .yardstick = "MRPT streaming read alone",
          .comparisons = {{"`range_odometry`, 1.1 million observations, 1 million estimates", "replay_ours/1",
                           "replay_mrpt_read", "real_time", "ms", 0.5},
                          {"`uwb_imu` eskf, 1.1 million observations, 20 estimates a second", "replay_eskf/1",
                           "replay_mrpt_read", "real_time", "ms", 0.909},
                          {"the same from its packed copy", "replay_eskf_copy", "replay_mrpt_read",
                           "real_time", "ms", 0.0}},
          .figures = {{"growth of the peak memory", "replay_ours/1", "memory_growth_kb", "kB"},
                      {"the same with three times the log", "replay_ours/3", "memory_growth_kb", "kB"},
                      {"of the eskf", "replay_eskf/1", "memory_growth_kb", "kB"},
                      {"of the eskf with three times the log", "replay_eskf/3", "memory_growth_kb", "kB"}}};
}

Topic inertial() {
  return {.title = "Simulated inertial unit",
          .yardstick = "its random numbers alone",
          .comparisons = {{"one sample, shearer on a bent conveyor", "sample_ours/conveyor", "sample_random",
                           "ns_per_sample", "ns", 0.0},
                          {"one sample, winding drive", "sample_ours/winding", "sample_random",
                           "ns_per_sample", "ns", 0.0}},
          .figures = {{"growth of the peak memory", "sample_ours/conveyor", "memory_growth_kb", "kB"}}};
}

Topic tunnelMap() {
  return {.title = "Tunnel map of 100 000 segments",
          .yardstick = "a walk through all segments",
          .comparisons = {{"nearest place in a roadway", "project", "projectThroughAllSegments", "cpu_time",
                           "ns", 0.0}},
          .figures = {{"one line of sight of 60 m", "lineOfSight60m", "cpu_time", "ns"},
                      {"building the network", "buildNetwork", "cpu_time", "ms"},
                      {"memory of the network, per segment", "buildNetwork", "bytes_per_segment", "B"}}};
}

Topic dualUwb() {
  const auto epoch = [](const char* what, const char* benchmark) {
    return Figure{what, benchmark, "ns_per_epoch", "ns"};
  };
  return {.title = "dual_uwb, an epoch of 8 ranges",
          .yardstick = "",
          .comparisons = {},
          .figures = {epoch("filter", "filter_epoch/ranges_8"),
                      epoch("filter with a bias state for each of 8 links",
                            "filter_epoch/ranges_8_with_8_bias_states"),
                      epoch("rigid fit from nothing", "rigid_epoch/ranges_8"),
                      epoch("rigid fit from a prediction", "rigid_epoch/ranges_8_from_prediction"),
                      epoch("one tag by itself, 4 ranges", "tag_epoch")}};
}

Topic sins() {
  return {
      .title = "sins_dr",
      .yardstick = "dense Eigen, 19 states",
      .comparisons = {{"strapdown and covariance, per sample at 200 Hz, flat Earth", "sample_ours/flat",
                       "sample_dense/flat", "ns_per_sample", "ns", 0.0},
                      {"the same on the ellipsoid", "sample_ours/ellipsoid", "sample_dense/ellipsoid",
                       "ns_per_sample", "ns", 0.0},
                      {"one comparison of the two positions", "update_ours", "update_dense", "ns_per_update",
                       "ns", 0.0}},
      .figures = {{"an hour at 200 Hz with wheels, from memory", "drive_ours", "epochs_per_s", "samples/s"}}};
}

Topic errorStateFilter() {
  return {.title = "uwb_imu and seamless: 15-state error filter, models mixed",
          .yardstick = "dense or general form",
          .comparisons = {{"step of state and covariance, per sample", "predict_structured", "predict_dense",
                           "ns_per_sample", "ns", 0.0},
                          {"one range", "range_sparse", "range_general", "ns_per_range", "ns", 0.0},
                          {"one tick of two models", "tick_ours", "tick_general", "ns_per_tick", "ns", 0.0}},
          .figures = {{"fuzzy controller, rules as printed", "fuzzy/paper", "ns_per_evaluation", "ns"},
                      {"a second of the circle run, eskf", "circle/eskf", "ns_per_run_second", "ns"}}};
}

Topic shearer() {
  return {.title = "shearer",
          .yardstick = "dense Eigen",
          .comparisons = {{"one scan's correction", "shearer_scan_ours", "shearer_scan_dense", "ns_per_scan",
                           "ns", 0.0}},
          .figures = {{"one inertial sample", "shearer_sample", "ns_per_sample", "ns"}}};
}

Topic legs() {
  return {.title = "Legs of supports in a sweep of 721 beams",
          .yardstick = "simulating the sweep",
          .comparisons = {{"all 17 in view", "find/whole_row", "sweep_simulated", "ns_per_sweep", "ns", 1.0},
                          {"all 17, robust weights", "find/whole_row_robust", "sweep_simulated",
                           "ns_per_sweep", "ns", 0.0},
                          {"the two that a filter uses", "find/two_legs_behind", "sweep_simulated",
                           "ns_per_sweep", "ns", 0.0}},
          .figures = {{"growth of the peak memory", "find/whole_row", "memory_growth_kb", "kB"}}};
}

}  // namespace

std::vector<Topic> topics() {
  return {particleFilter(), particleThreads(),  rangeOdometry(), dualUwb(), reading(),  replay(), inertial(),
          sins(),           errorStateFilter(), shearer(),       legs(),    tunnelMap()};
}

json parsed(const std::string& text) {
  static const std::regex kNoNumber(R"(: -?(NaN|Infinity)\b)");
  return json::parse(std::regex_replace(text, kNoNumber, ": null"));
}

json joined(const std::vector<json>& runs) {
  json result;
  for (const json& run : runs) {
    if (!run.contains("benchmarks")) throw std::invalid_argument("a run holds no benchmarks");
    if (result.is_null()) {
      result = run;
    } else {
      for (const json& entry : run.at("benchmarks")) result["benchmarks"].push_back(entry);
    }
  }
  if (result.is_null()) throw std::invalid_argument("no runs");
  return result;
}

std::string plainName(const json& entry) {
  const std::string name = entry.at("run_name");
  return name.substr(0,
                     std::min({name.find("/iterations:"), name.find("/repeats:"), name.find("/real_time")}));
}

double aggregate(const json& run, const std::string& statistic, const std::string& benchmark,
                 const std::string& counter) {
  for (const json& entry : run.at("benchmarks")) {
    if (entry.value("aggregate_name", "") != statistic || plainName(entry) != benchmark) continue;
    if (!entry.contains(counter))
      throw std::invalid_argument("benchmark " + benchmark + " has no counter " + counter);
    return entry.at(counter);
  }
  throw std::invalid_argument("no " + statistic + " of benchmark " + benchmark + ": run it with repetitions");
}

std::string machineLine(const json& run) {
  const json& context = run.at("context");
  const json load = context.value("load_avg", json::array());
  std::string line = std::to_string(context.at("num_cpus").get<int>()) + " CPUs at " +
                     std::to_string(context.at("mhz_per_cpu").get<int>()) + " MHz";
  if (!load.empty()) line += ", load average " + shown(load.front()) + " at the start";
  return line + ", " + context.at("date").get<std::string>().substr(0, 10);
}

std::string tables(const json& run, const std::vector<Topic>& topics) {
  std::string text;
  for (const Topic& topic : topics) text += (text.empty() ? "" : "\n") + table(run, topic);
  return text;
}

}  // namespace pos::bench
