/// `pos serve`: a run, a replay, a live feed or a map in the browser.

#include <chrono>
#include <fstream>
#include <memory>
#include <thread>

#include "pos/core/error.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "progress.hpp"
#include "serve_http.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string run;
  InputOptions inputs;
  std::string live;
  std::optional<int> live_tcp;
  std::string out;
  std::string address = "127.0.0.1";
  int port = 8765;
  std::string token;
  std::string interface;
  bool play = false;
  LockedVehicle vehicle;
  serve::ConnectionRules connections;

  std::optional<LockedVehicle> locked() const {
    return vehicle.route.empty() ? std::nullopt : std::optional(vehicle);
  }
  bool isLive() const { return !live.empty() || live_tcp.has_value(); }
};

[[noreturn]] void refuse(const std::string& what, const std::string& key, const std::string& suggestion) {
  throw UsageError(Complaint{.what = what, .key = key, .suggestion = suggestion});
}

void requireSense(const Options& options) {
  const bool config = !options.inputs.config.empty();
  if (!options.run.empty() && (config || options.isLive()))
    refuse("a finished run and a configuration cannot be shown together", "--run", "leave one of them out");
  if (options.run.empty() && !config && options.inputs.map.empty())
    refuse("there is nothing to show", "", "give --run FOLDER, --config FILE or --map FILE");
  if (options.isLive() && !config)
    refuse("a live feed needs to know what to do with it", "--config", "give --config FILE");
  if (options.isLive() && options.out.empty())
    refuse("a live feed is recorded, and no folder for it is named", "--out", "give --out FOLDER");
  if (!options.isLive() && !options.out.empty())
    refuse("only a live feed is recorded", "--out", "pos replay --out keeps the results of a log");
  if (!options.vehicle.route.empty() && options.run.empty() && !config)
    refuse("a map alone has no vehicle to hold locks", "--route", "give --run FOLDER or --config FILE");
  if (options.vehicle.reversed && options.vehicle.route.empty())
    refuse("there is no route to be driven from its end", "--reversed", "give --route ID");
  if (!options.live.empty() && options.live != "-")
    refuse("live measurements come from standard input or TCP", "--live", "--live -, or --live-tcp PORT");
}

/// The configuration without log and truth; its scenario only tells which map.
Inputs liveInputs(const Options& options) {
  io::RunConfig config = loadConfig(options.inputs);
  if (!config.map && config.scenario)
    config.map = io::loadScenario(config.scenario->file, {}, mrptShare()).map;
  config.scenario.reset();
  config.truth.reset();
  config.log = io::LogSource{fs::absolute(options.out) / "log.rawlog"};
  return loadInputs(std::move(config));
}

std::unique_ptr<Session> sessionOf(const Options& options, const Clock& clock, const Voice& voice) {
  if (!options.run.empty()) return runSession(options.run, options.locked(), clock, voice);
  if (options.inputs.config.empty()) return mapSession(options.inputs.map);
  if (!options.isLive()) {
    return replaySession(
        loadInputs(options.inputs),
        {.play = options.play, .vehicle = options.locked(), .connections = options.connections}, clock);
  }
  return liveSession(liveInputs(options),
                     {.folder = options.out,
                      .standard_input = !options.live.empty(),
                      .tcp = options.live_tcp,
                      .address = options.address,
                      .vehicle = options.locked(),
                      .connections = options.connections},
                     clock, voice);
}

/// The map that is shown: the one named here, else that of the run.
std::optional<fs::path> mapFileOf(const Options& options) {
  if (!options.inputs.map.empty()) return fs::absolute(options.inputs.map);
  return std::nullopt;
}

bool isLoopback(const std::string& address) {
  return address == "127.0.0.1" || address == "localhost" || address == "::1";
}

std::string newToken() {
  std::ifstream random("/dev/urandom", std::ios::binary);
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[static_cast<unsigned char>(random.get()) & 15U];
  if (!random) throw DataError("no random numbers for a token: /dev/urandom cannot be read");
  return token;
}

serve::Guard guardOf(const Options& options, const Voice& voice) {
  if (isLoopback(options.address)) return {};
  voice.warn("everybody who reaches " + options.address +
             " and has the token can see and drive this; the connection is not encrypted");
  return {.loopback = false, .token = options.token.empty() ? newToken() : options.token};
}

/// Ends when the user does, or when the show cannot go on.
void watch(HttpServer& server, Session& session, Hub& hub, const std::atomic<bool>& done) {
  while (!done && !interrupted() && session.fault() == nullptr)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  hub.close();
  server.stop();
}

ExitCode runServe(const Options& options, const Voice& voice) {
  requireSense(options);
  const Clock clock = [] {
    return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
  };
  const serve::Guard guard = guardOf(options, voice);
  const std::unique_ptr<Session> session = sessionOf(options, clock, voice);
  const auto map_file = mapFileOf(options);
  const auto shown = map_file ? map_file : session->mapFile();
  std::optional<serve::MapService> map;
  if (shown) {
    map.emplace(*shown, map_file ? serve::MapService::Access::Editable : serve::MapService::Access::ReadOnly);
  }
  Hub hub;
  Ticker ticker(*session, hub, clock);
  Site site{.session = *session,
            .hub = hub,
            .ticker = ticker,
            .map = map ? &*map : nullptr,
            .guard = guard,
            .assets = assetsOf(interfaceFolder(options.interface)),
            .connections = options.connections};
  HttpServer server(site);
  const int port = server.bind(options.address, options.port);
  const std::string query = guard.loopback ? "" : "?token=" + guard.token;
  print("http://" + options.address + ":" + std::to_string(port) + "/" + query + "\n");
  flushOutput();
  watchInterrupts();
  std::atomic<bool> done{false};
  std::thread watcher([&] { watch(server, *session, hub, done); });
  server.run();
  done = true;
  watcher.join();
  if (const std::exception_ptr fault = session->fault()) std::rethrow_exception(fault);
  return ExitCode::Ok;
}

}  // namespace

void addServe(const Verbs& verbs) {
  CLI::App* verb =
      verbs.app->add_subcommand("serve", "Show a run, a replay, a live feed or a map in a browser");
  auto options = std::make_shared<Options>();
  verb->add_option("--run", options->run, "Finished run: the folder that `pos replay --out` wrote");
  verb->add_option("--config", options->inputs.config,
                   "Configuration to replay, or to run live data through");
  addInputChoices(*verb, options->inputs);
  verb->add_option("--live", options->live, "Live: JSON lines from standard input (-)");
  verb->add_option("--live-tcp", options->live_tcp, "Live: JSON lines at this TCP port (0: any)")
      ->check(CLI::Range(0, 65535));
  verb->add_option("--out", options->out, "Live: new folder for the recording and the results");
  verb->add_flag("--play", options->play, "Replay: begin at once");
  verb->add_option(
      "--route", options->vehicle.route,
      "Route of the map that the vehicle drives: locks by the lock rules, not by its place alone");
  verb->add_flag("--reversed", options->vehicle.reversed, "It drives the route from its end");
  verb->add_option("--port", options->port, "Port (0: any free one)")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  verb->add_option("--address", options->address, "Another address than this machine's own; needs a token")
      ->capture_default_str();
  verb->add_option("--token", options->token, "Token for --address, instead of a random one");
  verb->add_option("--interface", options->interface, "Folder of the built browser interface");
  verb->add_option("--stale-after", options->connections.stale_after, "A source is stale after so many s")
      ->capture_default_str();
  verb->add_option("--lost-after", options->connections.lost_after, "And lost after so many s")
      ->capture_default_str();
  addVoice(*verb, *verbs.voice);
  verb->footer(
      "The address to open is printed on standard output. --map names the one file that the map editor "
      "may write.\nEnds with Ctrl-C.");
  verb->callback([options, verbs] { *verbs.code = runServe(*options, *verbs.voice); });
}

}  // namespace pos::app
