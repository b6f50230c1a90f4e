/// The command `pos`: one binary, verbs, one place where errors become messages and exit codes.

#include <exception>
#include <iostream>

#include "common.hpp"
#include "pos/core/error.hpp"

namespace {

using pos::app::ExitCode;

int toInt(ExitCode code) {
  return static_cast<int>(code);
}

/// CLI11's own errors keep their texts; its codes become ours.
int usage(const CLI::App& app, const CLI::ParseError& error) {
  const bool asked_for_help = error.get_exit_code() == 0;
  app.exit(error, std::cout, std::cerr);
  return toInt(asked_for_help ? ExitCode::Ok : ExitCode::Usage);
}

int run(int argc, char** argv) {
  CLI::App app{
      "Positioning for vehicles under ground: replay logs, compare estimators, see how good each answer is.",
      "pos"};
  app.require_subcommand(1);
  app.set_version_flag("--version", pos::app::version());
  app.failure_message([](const CLI::App* failed, const CLI::Error& error) {
    return std::string("error: ") + error.what() + "\n  try:      " + failed->get_name() + " --help\n";
  });
  pos::app::Voice voice;
  ExitCode code = ExitCode::Ok;
  const pos::app::Verbs verbs{&app, &voice, &code};
  pos::app::addReplay(verbs);
  pos::app::addEvaluate(verbs);
  pos::app::addConvert(verbs);
  pos::app::addCalibrate(verbs);
  pos::app::addInfo(verbs);
  pos::app::addConfig(verbs);
  pos::app::addReport(verbs);
  pos::app::addVersion(verbs);
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
