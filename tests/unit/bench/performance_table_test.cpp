#include "bench/tools/performance_table.hpp"

#include <gtest/gtest.h>

namespace pos::bench {
namespace {

nlohmann::json entry(const std::string& run_name, const std::string& aggregate, double cpu_time,
                     double per_item) {
  return {{"run_name", run_name},
          {"aggregate_name", aggregate},
          {"cpu_time", cpu_time},
          {"ns_per_item", per_item},
          {"memory_growth_kb", 10.0 * per_item}};
}

nlohmann::json sample() {
  return {{"context",
           {{"date", "2026-03-01T10:00:00+00:00"},
            {"host_name", "pit-7"},
            {"num_cpus", 2},
            {"mhz_per_cpu", 4500},
            {"load_avg", {0.25, 0.5, 0.75}}}},
          {"benchmarks",
           {entry("fast", "mean", 99.0, 99.0), entry("fast", "median", 100.0, 2.0),
            entry("fast", "max", 120.0, 3.0), entry("slow/iterations:1/repeats:5", "median", 150.0, 31.0)}}};
}

const Topic kTopic{
    .title = "Weighing",
    .yardstick = "MRPT",
    .comparisons = {{"per item", "fast", "slow", "ns_per_item", "ns", 10.0},
                    {"in all", "fast", "slow", "cpu_time", "ms", 2.0},
                    {"untargeted", "slow", "fast", "cpu_time", "ms", 0.0}},
    .figures = {{"memory", "fast", "memory_growth_kb", "kB"}},
};

TEST(PerformanceTable, MediansBecomeRowsWithTheirFactorAndTarget) {
  EXPECT_EQ(tables(sample(), {kTopic}),
            "### Weighing\n"
            "\n"
            "| | ours | MRPT | times faster | target |\n"
            "| --- | --- | --- | --- | --- |\n"
            "| per item | 2.00 ns | 31.0 ns | 15.5 | >= 10.0, met |\n"
            "| in all | 100 ms | 150 ms | 1.50 | >= 2.00, missed |\n"
            "| untargeted | 150 ms | 100 ms | 0.67 | - |\n"
            "\n"
            "| | |\n"
            "| --- | --- |\n"
            "| memory | 30.0 kB |\n");
}

TEST(PerformanceTable, FiguresWithoutAYardstickStandAlone) {
  const Topic topic{.title = "Memory",
                    .yardstick = "",
                    .comparisons = {},
                    .figures = {{"memory", "fast", "memory_growth_kb", "kB"}}};
  EXPECT_EQ(tables(sample(), {topic}), "### Memory\n\n| | |\n| --- | --- |\n| memory | 30.0 kB |\n");
}

TEST(PerformanceTable, MachineIsToldWithoutItsName) {
  EXPECT_EQ(machineLine(sample()), "2 CPUs at 4500 MHz, load average 0.25 at the start, 2026-03-01");
}

TEST(PerformanceTable, RunsOfSeveralProgramsAreJoinedInOrder) {
  nlohmann::json other = sample();
  other["benchmarks"] = nlohmann::json::array({entry("third", "median", 1.0, 1.0)});
  const nlohmann::json run = joined({sample(), other});
  ASSERT_EQ(run.at("benchmarks").size(), 5U);
  EXPECT_EQ(run.at("benchmarks").back().at("run_name"), "third");
  EXPECT_THROW(joined({}), std::invalid_argument);
  EXPECT_THROW(joined({nlohmann::json::object()}), std::invalid_argument);
}

TEST(PerformanceTable, NumbersThatDoNotExistBecomeNull) {
  const nlohmann::json run = parsed(R"({"a": NaN, "b": -Infinity, "c": -2.5})");
  EXPECT_TRUE(run.at("a").is_null());
  EXPECT_TRUE(run.at("b").is_null());
  EXPECT_EQ(run.at("c"), -2.5);
}

TEST(PerformanceTable, MissingBenchmarkOrCounterIsNamed) {
  const auto messageOf = [](const Topic& topic) -> std::string {
    try {
      tables(sample(), {topic});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  Topic topic = kTopic;
  topic.comparisons = {{"x", "faster", "slow", "cpu_time", "ms", 0.0}};
  EXPECT_EQ(messageOf(topic), "no median of benchmark faster: run it with repetitions");
  topic.comparisons = {{"x", "fast", "slow", "ns_per_mile", "ns", 0.0}};
  EXPECT_EQ(messageOf(topic), "benchmark fast has no counter ns_per_mile");
  topic.comparisons = {};
  topic.figures = {{"x", "slow", "memory_growth_kb", "kB"}};
  EXPECT_EQ(messageOf(topic), "no max of benchmark slow: run it with repetitions");
}

}  // namespace
}  // namespace pos::bench
