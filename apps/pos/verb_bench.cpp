/// `pos bench`: runs the benchmark programs and tells how many times faster than its yardstick each hot path
/// is.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bench/tools/performance_table.hpp"
#include "bench_history.hpp"
#include "bench_programs.hpp"
#include "common.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/report/comparison.hpp"
#include "pos/report/text.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using bench::QuickPair;
using bench::Ratio;
using nlohmann::json;

/// A pair that seems to have got worse is measured so often before it is believed, and any before it is
/// recorded.
constexpr int kTries = 3;

struct Options {
  bool quick = false;
  bool json = false;
  bool record = false;
  std::string programs;
  std::string markdown;
  std::string history;
};

std::string compiler() {
  return std::string(POS_COMPILER) + ", " + POS_COMPILER_FLAGS;
}

json measured(const fs::path& program, std::vector<std::string> arguments, const Voice& voice) {
  voice.say("running " + program.filename().string());
  // Repetitions in mixed order: a machine that slows down on the way slows both sides.
  arguments.insert(arguments.end(),
                   {"--benchmark_format=json", "--benchmark_enable_random_interleaving=true"});
  try {
    return bench::parsed(outputOf(program, arguments));
  } catch (const json::exception& error) {
    throw DataError(Complaint{.what = "a benchmark program wrote no JSON",
                              .place = {.file = program.string()},
                              .got = error.what()});
  }
}

json wholeRun(const fs::path& folder, const Voice& voice) {
  std::vector<json> runs;
  for (const std::string& program : benchPrograms(folder)) {
    runs.push_back(measured(folder / program,
                            {"--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true"}, voice));
  }
  return bench::joined(runs);
}

/// The pairs of one program, measured within seconds.
std::vector<Ratio> quickRatios(const fs::path& folder, const std::string& program, const Voice& voice) {
  std::vector<QuickPair> pairs = bench::quickPairs();
  std::erase_if(pairs, [&](const QuickPair& pair) { return pair.program != program; });
  const auto topics = bench::topics();
  const json run = measured(folder / program,
                            {"--benchmark_filter=" + bench::filterOf(topics, pairs),
                             "--benchmark_min_time=0.04", "--benchmark_repetitions=7"},
                            voice);
  return bench::bestRatios(run, topics, pairs);
}

/// The pairs of these programs, or of all of them.
std::vector<Ratio> quickRatios(const fs::path& folder, const std::set<std::string>& programs,
                               const Voice& voice) {
  std::vector<Ratio> ratios;
  for (const std::string& program : programs) {
    const auto own = quickRatios(folder, program, voice);
    ratios.insert(ratios.end(), own.begin(), own.end());
  }
  return ratios;
}

std::set<std::string> quickPrograms() {
  std::set<std::string> programs;
  for (const QuickPair& pair : bench::quickPairs()) programs.insert(pair.program);
  return programs;
}

/// Those with a pair that got worse.
std::set<std::string> suspects(const std::vector<JudgedRatio>& ratios) {
  std::set<std::string> programs;
  for (const JudgedRatio& one : ratios) {
    for (const QuickPair& pair : bench::quickPairs())
      if (one.worse && pair.ours == one.ratio.pair) programs.insert(pair.program);
  }
  return programs;
}

/// What is compared: programs with a pair that got worse are run again, and the best counts.
std::vector<JudgedRatio> comparedRun(const fs::path& folder, const std::vector<RecordedRatio>& history,
                                     const Voice& voice) {
  std::vector<Ratio> ratios = quickRatios(folder, quickPrograms(), voice);
  for (int tries = 1; tries < kTries; ++tries) {
    const auto again = quickRatios(folder, suspects(judged(ratios, history, processorModel())), voice);
    for (Ratio& known : ratios) {
      for (const Ratio& one : again)
        if (known.pair == one.pair && known.ratio < one.ratio) known = one;
    }
  }
  return judged(ratios, history, processorModel());
}

/// What is recorded: of several runs the middle one, neither a lucky nor an unlucky one.
std::vector<JudgedRatio> recordedRun(const fs::path& folder, const Voice& voice) {
  std::array<std::vector<Ratio>, kTries> runs;
  for (auto& run : runs) run = quickRatios(folder, quickPrograms(), voice);
  std::vector<Ratio> middle;
  for (std::size_t pair = 0; pair < runs.front().size(); ++pair) {
    std::array<Ratio, kTries> of_pair;
    std::transform(runs.begin(), runs.end(), of_pair.begin(), [&](const auto& run) { return run[pair]; });
    std::sort(of_pair.begin(), of_pair.end(),
              [](const Ratio& a, const Ratio& b) { return a.ratio < b.ratio; });
    middle.push_back(of_pair[of_pair.size() / 2]);
  }
  return judged(middle, {}, processorModel());
}

std::string table(const std::vector<JudgedRatio>& ratios) {
  report::Comparison table{.columns = {"pair", "ours", "yardstick", "times faster", "recorded", ""},
                           .rows = {}};
  for (const auto& [ratio, recorded, worse] : ratios) {
    table.rows.push_back({{ratio.pair},
                          {report::rounded(ratio.ours) + " " + ratio.unit},
                          {report::rounded(ratio.theirs) + " " + ratio.unit},
                          {report::rounded(ratio.ratio)},
                          {recorded ? report::rounded(*recorded) : "-"},
                          {worse ? "WORSE" : ""}});
  }
  return report::tableText(table);
}

std::string jsonText(const std::vector<JudgedRatio>& ratios) {
  json list = json::array();
  for (const auto& [ratio, recorded, worse] : ratios) {
    list.push_back({{"pair", ratio.pair},
                    {"what", ratio.what},
                    {"yardstick", ratio.yardstick},
                    {"unit", ratio.unit},
                    {"ours", ratio.ours},
                    {"theirs", ratio.theirs},
                    {"ratio", ratio.ratio},
                    {"recorded", recorded ? json(*recorded) : json()},
                    {"worse", worse}});
  }
  const json all{{"format", "pos.bench/1"},
                 {"processor", processorModel()},
                 {"compiler", compiler()},
                 {"least_share", kLeastShare},
                 {"ratios", list}};
  return all.dump(2) + "\n";
}

std::string today() {
  const std::chrono::year_month_day day(
      std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02u", static_cast<int>(day.year()),
                static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
  return text;
}

void record(const fs::path& file, const std::vector<JudgedRatio>& ratios, const std::string& date) {
  std::vector<RecordedRatio> rows;
  rows.reserve(ratios.size());
  for (const JudgedRatio& one : ratios)
    rows.push_back({date, processorModel(), POS_COMPILER, one.ratio.pair, one.ratio.ratio});
  appendHistory(file, rows);
}

void judge(const std::vector<JudgedRatio>& ratios, const Options& options, const Voice& voice) {
  const auto known = std::count_if(ratios.begin(), ratios.end(), [](const auto& r) { return r.recorded; });
  if (known == 0) {
    voice.warn("nothing is recorded of the processor '" + processorModel() + "', so nothing was compared; " +
               "to record these ratios: scripts/bench --record");
  }
  std::vector<std::string> worse;
  for (const JudgedRatio& one : ratios)
    if (one.worse) worse.push_back(one.ratio.pair);
  if (worse.empty()) return;
  throw RequirementMissed(
      Complaint{.what = "slower against their yardsticks than recorded, in the best of " +
                        std::to_string(kTries) + " runs: " + io::text::joined(worse),
                .place = {.file = options.history},
                .expected = "at least " + report::percent(kLeastShare) + " of the recorded ratio",
                .suggestion = "find what made them slow; where that is meant, scripts/bench --record"});
}

std::vector<JudgedRatio> ratiosOf(const Options& options, const fs::path& folder, const Voice& voice) {
  const auto history = options.history.empty() ? std::vector<RecordedRatio>{} : readHistory(options.history);
  if (options.quick) return options.record ? recordedRun(folder, voice) : comparedRun(folder, history, voice);
  const json run = wholeRun(folder, voice);
  if (!options.markdown.empty()) {
    writeFile(options.markdown, "Machine: " + processorModel() + ", " + bench::machineLine(run) + ".\n\n" +
                                    bench::tables(run, bench::topics()) + "\nCompiler: " + compiler() +
                                    ", no `-march`.\n");
  }
  return judged(bench::medianRatios(run, bench::topics()), {}, processorModel());
}

ExitCode runBench(const Options& options, const Voice& voice) {
  const fs::path folder = benchFolder(options.programs);
  std::vector<JudgedRatio> ratios;
  try {
    ratios = ratiosOf(options, folder, voice);
  } catch (const std::invalid_argument& missing) {  // a program is not there, or measures something else
    throw DataError(Complaint{.what = missing.what(),
                              .place = {.file = folder.string()},
                              .suggestion = "scripts/build release --target bench"});
  }
  print(options.json ? jsonText(ratios) : table(ratios));
  if (options.history.empty()) return ExitCode::Ok;
  if (!options.record) {
    judge(ratios, options, voice);
    return ExitCode::Ok;
  }
  record(options.history, ratios, today());
  voice.say("recorded in " + options.history);
  return ExitCode::Ok;
}

}  // namespace

void addBench(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand(
      "bench", "Run the benchmarks and say how much faster than their yardsticks we are");
  auto options = std::make_shared<Options>();
  CLI::Option* quick =
      verb->add_flag("--quick", options->quick, "Only the pairs that repeat well, in less than a minute");
  verb->add_flag("--json", options->json, "Print JSON");
  verb->add_option("--markdown", options->markdown, "File for the tables of docs/performance.md")
      ->excludes(quick);
  CLI::Option* history =
      verb->add_option("--history", options->history,
                       "CSV of recorded ratios; exit code 4 when one got worse by more than a quarter")
          ->needs(quick);
  verb->add_flag("--record", options->record, "Add this run to --history, instead of comparing")
      ->needs(history);
  verb->add_option("--programs", options->programs, "Folder of the programs bench_*, instead of pos's own");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runBench(*options, *verbs.voice); });
}

}  // namespace pos::app
