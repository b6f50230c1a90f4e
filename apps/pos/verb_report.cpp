/// `pos report`: the report of a run folder, made again (after the folder was copied, or pos got better
/// pictures).

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "outputs.hpp"
#include "pos/core/error.hpp"
#include "pos/report/html.hpp"
#include "replay.hpp"
#include "viewer_page.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string folder;
  std::string out;
  std::string interface;
};

std::string resolvedConfigOf(const fs::path& folder) {
  const fs::path path = folder / "run.json";
  std::ifstream file(path);
  if (!file) {
    throw DataError(Complaint{.what = "this is no run folder: it has no run.json",
                              .place = {.file = path.string()},
                              .suggestion = "give the folder that `pos replay --out` wrote"});
  }
  try {
    return nlohmann::json::parse(file).at("config").get<std::string>();
  } catch (const nlohmann::json::exception& error) {
    throw DataError(
        Complaint{.what = "run.json cannot be read", .place = {.file = path.string()}, .got = error.what()});
  }
}

/// The run is repeated from its resolved configuration: same inputs, same seed, same bytes.
ExitCode runReport(const Options& options, const Voice& voice) {
  const std::string yaml = resolvedConfigOf(options.folder);
  const fs::path origin = fs::path(options.folder) / "run.json";
  const Inputs inputs = loadInputs(io::runConfigFrom(io::parseYaml(yaml, origin), mrptShare()));
  const Replayed result = replayed(
      inputs, nullptr, [](std::uint64_t, Stamp) { return true; }, Keep::ForTheReport);
  const bool in_folder = options.out.empty();
  const fs::path out = in_folder ? fs::path(options.folder) / "report.html" : fs::path(options.out);
  const auto viewer = in_folder ? viewerTemplate(options.interface) : std::nullopt;
  report::ReportExtras extras = extrasOf(inputs, result);
  if (viewer) extras.viewer = kViewerFile;
  writeFile(out, report::reportHtml(summaryOf(inputs, result), yaml, extras));
  if (viewer) writeViewer(options.folder, inputs, *viewer);
  voice.say("report: " + out.string());
  return ExitCode::Ok;
}

}  // namespace

void addReport(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("report", "Make the report of a run folder again");
  auto options = std::make_shared<Options>();
  verb->add_option("folder", options->folder, "Run folder written by `pos replay --out`")->required();
  verb->add_option("--out", options->out, "HTML file to write, instead of the folder's report.html");
  verb->add_option("--interface", options->interface,
                   "Folder of the built browser interface, for viewer.html beside report.html");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runReport(*options, *verbs.voice); });
}

}  // namespace pos::app
