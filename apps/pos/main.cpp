/// The command `pos`: one binary, verbs, one place where errors become messages and exit codes.

#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>

#include "common.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"

namespace {

using pos::app::ExitCode;

int toInt(ExitCode code) {
  return static_cast<int>(code);
}

/// The verb that the user got as far as, "pos config check".
const CLI::App& deepest(const CLI::App& app) {
  const auto verbs = app.get_subcommands();
  return verbs.empty() ? app : deepest(*verbs.front());
}

std::string spelt(const CLI::App& verb) {
  return verb.get_parent() == nullptr ? verb.get_name() : spelt(*verb.get_parent()) + " " + verb.get_name();
}

/// Everything the user could have meant at this place.
std::vector<std::string> known(const CLI::App& verb, bool options) {
  std::vector<std::string> names;
  if (!options) {
    for (const CLI::App* each : verb.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(each->get_name());
    return names;
  }
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// A word that has no place here, with the nearest that has one.
std::string unknownWord(const CLI::App& verb, const std::string& word) {
  const bool option = word.starts_with("-");
  const std::vector<std::string> names = known(verb, option);
  const bool no_verb = !option && !names.empty();
  const auto near = pos::io::nearestName(word.substr(0, word.find('=')), names);
  std::string text = option ? "unknown option " : no_verb ? "unknown verb " : "this is one word too many: ";
  text += "'" + word + "'";
  if (no_verb) text += "\n  expected: one of: " + pos::io::text::joined(names);
  return text + "\n  try:      " + (near ? "did you mean " + *near + "?" : spelt(verb) + " --help");
}

/// A wrong word comes before what is missing: `pos replay --ot x` is no call for a configuration.
std::string usageMessage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& verb = deepest(app);
  std::vector<std::string> left = verb.remaining();
  if (left.empty()) left = app.remaining(true);
  const auto option =
      std::find_if(left.begin(), left.end(), [](const std::string& w) { return w.starts_with("-"); });
  if (!left.empty()) return unknownWord(verb, option != left.end() ? *option : left.front());
  const std::vector<std::string> verbs = known(verb, false);
  if (!verbs.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    return spelt(verb) + " needs a verb\n  expected: one of: " + pos::io::text::joined(verbs) +
           "\n  try:      " + spelt(verb) + " --help";
  }
  return std::string(error.what()) + "\n  try:      " + spelt(verb) + " --help";
}

int usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {  // help and version were asked for
    app.exit(error, std::cout, std::cerr);
    return toInt(ExitCode::Ok);
  }
  std::cerr << "error: " << usageMessage(app, error) << "\n";
  return toInt(ExitCode::Usage);
}

/// "INT:INT in [0 - 65535]" says INT twice, and where the words are told TEXT says nothing.
class HelpText : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || colon == 0) return text;
    const std::string type = text.substr(1, colon - 1);
    const std::string rest = text.substr(colon + 1);
    return rest.starts_with("{") || rest.starts_with(type + " ") ? " " + rest : text;
  }
};

/// Help speaks of verbs at every depth.
void nameVerbs(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    verb->group("Verbs");
    nameVerbs(*verb);
  }
}

int run(int argc, char** argv) {
  CLI::App app{
      "Positioning for vehicles under ground: replay logs, compare estimators, see how good each answer is.",
      "pos"};
  app.require_subcommand(1);
  app.set_version_flag("--version", pos::app::version());
  app.formatter(std::make_shared<HelpText>());
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  pos::app::Voice voice;
  ExitCode code = ExitCode::Ok;
  const pos::app::Verbs verbs{&app, &voice, &code};
  pos::app::addReplay(verbs);
  pos::app::addCampaign(verbs);
  pos::app::addEvaluate(verbs);
  pos::app::addConvert(verbs);
  pos::app::addCalibrate(verbs);
  pos::app::addInfo(verbs);
  pos::app::addMap(verbs);
  pos::app::addLocks(verbs);
  pos::app::addConfig(verbs);
  pos::app::addReport(verbs);
  pos::app::addSimulate(verbs);
  pos::app::addServe(verbs);
  pos::app::addVersion(verbs);
  pos::app::addBench(verbs);
  pos::app::addCompletion(verbs);
  pos::app::addMan(verbs);
  nameVerbs(app);
  app.footer(
      "Exit codes: 0 done, 1 fault of pos, 2 command line, 3 configuration or map, 4 a --require missed,\n"
      "5 log, truth or table missing or damaged, 130 interrupted. `pos VERB --help` explains a verb.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return usage(app, error);
  }
  return toInt(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const pos::Error& error) {
    std::cerr << "error: " << error.what() << "\n";
    return error.exitCode();
  } catch (const std::exception& error) {
    std::cerr << "internal error: " << error.what()
              << "\n  This is a fault of pos itself; please report it with the command you ran.\n";
    return toInt(ExitCode::Internal);
  }
}
