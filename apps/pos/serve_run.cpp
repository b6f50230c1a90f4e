/// A finished run folder, played from its tables; and a map without any run.

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"
#include "pos/serve/request.hpp"
#include "serve_recorded.hpp"
#include "serve_session.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

/// What run.json says, with everything that can still be loaded.
Inputs inputsOf(const fs::path& folder, const Voice& voice) {
  const fs::path path = folder / "run.json";
  nlohmann::json run;
  try {
    run = nlohmann::json::parse(io::fileText(
        io::existingFile(path, Complaint{.suggestion = "give the folder that `pos replay --out` wrote"})));
  } catch (const nlohmann::json::exception& error) {
    throw DataError(
        Complaint{.what = "run.json cannot be read", .place = {.file = path.string()}, .got = error.what()});
  }
  io::RunConfig config =
      io::runConfigFrom(io::parseYaml(run.at("config").get<std::string>(), path), mrptShare());
  try {
    return loadInputs(config);
  } catch (const Error& missing) {
    voice.warn(
        std::string("map and truth of the run are not to be had, its results are shown without them: ") +
        missing.what());
    return Inputs{std::move(config), std::make_shared<const map::TunnelMap>(), std::nullopt};
  }
}

class RunShow final : public Session {
 public:
  RunShow(const fs::path& folder, const Inputs& inputs, const std::optional<LockedVehicle>& vehicle,
          const Clock& clock, std::size_t most_rows)
      : folder_(folder),
        clock_(clock),
        most_rows_(most_rows),
        stage_(sceneryOf(inputs, serve::Mode::Run, vehicle)),
        playhead_(Stamp{}) {
    setMapFile(inputs);
    loadEstimators();
    loadEvents();
    if (stage_.first()) playhead_ = serve::Playhead(*stage_.first());
  }

  Stage& stage() override { return stage_; }
  const fs::path* folder() const override { return &folder_; }

  serve::Show show() override {
    const std::lock_guard lock(mutex_);
    const Duration now = clock_();
    Stamp stamp = playhead_.at(now);
    const bool ended = stage_.last() && stamp >= *stage_.last();
    if (ended) {
      stamp = *stage_.last();
      playhead_.pause(now);
      playhead_.seek(stamp, now);
    }
    serve::Show show = pictureAt(stamp);
    show.playing = playhead_.playing();
    show.speed = playhead_.speed();
    show.ended = ended;
    return show;
  }

  serve::Show showAt(Stamp stamp) override {
    serve::Show show = pictureAt(stamp);
    show.ended = stage_.last() && stamp >= *stage_.last();
    return show;
  }

  void command(const serve::Command& command) override {
    using Kind = serve::Command::Kind;
    const std::lock_guard lock(mutex_);
    const Duration now = clock_();
    if (command.kind == Kind::Record) refuseInThisMode("a finished run cannot be recorded");
    if (command.kind == Kind::Play) {
      if (stage_.last() && playhead_.at(now) >= *stage_.last()) playhead_.seek(*stage_.first(), now);
      playhead_.play(now);
    }
    if (command.kind == Kind::Pause) playhead_.pause(now);
    if (command.kind == Kind::Speed) playhead_.setSpeed(command.speed, now);
    if (command.kind == Kind::Seek && stage_.first())
      playhead_.seek(std::clamp(command.stamp, *stage_.first(), *stage_.last()), now);
  }

 private:
  void loadEstimators() {
    std::optional<Stamp> first;
    std::optional<Stamp> last;
    for (std::size_t i = 0; i < stage_.scenery().estimators.size(); ++i) {
      const std::string& name = stage_.scenery().estimators[i].name;
      recorded_.push_back(recordedIn(folder_, name, stage_.scenery().names, most_rows_));
      const Recorded& recorded = recorded_.back();
      for (const Estimate& estimate : recorded.estimates) {
        const auto* place = latest(recorded.places, estimate.stamp);
        stage_.estimate(i, estimate, place != nullptr ? std::optional(*place) : std::nullopt);
      }
      if (recorded.estimates.empty()) continue;
      const Stamp begin = recorded.estimates.front().stamp;
      const Stamp end = recorded.estimates.back().stamp;
      first = first ? std::min(*first, begin) : begin;
      last = last ? std::max(*last, end) : end;
    }
    stage_.setSpan(first, last);
  }

  void loadEvents() {
    if (!fs::exists(folder_ / "events.csv")) return;
    io::CsvReader table(folder_ / "events.csv");
    const std::size_t stamp = table.column("stamp_s");
    while (table.next()) {
      stage_.event({.stamp = Stamp{table.duration(stamp, io::text::TimeUnit::Seconds)},
                    .estimator = std::string(table.cell(table.column("estimator"))),
                    .kind = std::string(table.cell(table.column("kind"))),
                    .sensor = std::string(table.cell(table.column("sensor"))),
                    .detail = std::string(table.cell(table.column("detail")))});
    }
  }

  serve::EstimatorState stateAt(std::size_t i, Stamp stamp) const {
    const Recorded& recorded = recorded_[i];
    serve::EstimatorState state{.name = stage_.scenery().estimators[i].name,
                                .type = stage_.scenery().estimators[i].type};
    const Estimate* estimate = latest(recorded.estimates, stamp);
    if (estimate == nullptr) return state;
    state.estimate = *estimate;
    state.verdicts = recorded.totals[static_cast<std::size_t>(estimate - recorded.estimates.data())];
    if (const auto* place = latest(recorded.places, stamp)) state.place = *place;
    if (const auto truth = stage_.truthAt(estimate->stamp))
      state.error = (truth->translation - estimate->T_map_body.translation).head<2>().norm();
    return state;
  }

  serve::Show pictureAt(Stamp stamp) const {
    serve::Show show{.mode = serve::Mode::Run,
                     .stamp = stamp,
                     .first = stage_.first(),
                     .last = stage_.last(),
                     .truth = stage_.truthAt(stamp)};
    show.locks = stage_.locksAt(stamp);
    for (std::size_t i = 0; i < recorded_.size(); ++i) show.estimators.push_back(stateAt(i, stamp));
    return show;
  }

  fs::path folder_;
  Clock clock_;
  std::size_t most_rows_;
  Stage stage_;
  std::vector<Recorded> recorded_;
  std::mutex mutex_;
  serve::Playhead playhead_;
};

class MapShow final : public Session {
 public:
  explicit MapShow(Inputs inputs) : stage_(sceneryOf(inputs, serve::Mode::Map)) {}
  Stage& stage() override { return stage_; }
  serve::Show show() override { return {.mode = serve::Mode::Map}; }
  void command(const serve::Command&) override { refuseInThisMode("a map alone has nothing to play"); }

 private:
  Stage stage_;
};

}  // namespace

serve::Show Session::showAt(Stamp) {
  refuseInThisMode("only a finished run can be asked for another moment");
}

void Session::setMapFile(const Inputs& inputs) {
  for (const InputFile& input : inputFiles(inputs)) {
    if (input.role == "map") map_file_ = input.file;
  }
}

void refuseInThisMode(const std::string& what) {
  throw serve::RequestError(409, "not_in_this_mode", Complaint{.what = what});
}

std::unique_ptr<Session> runSession(const std::string& folder, const std::optional<LockedVehicle>& vehicle,
                                    const Clock& clock, const Voice& voice) {
  return std::make_unique<RunShow>(folder, inputsOf(folder, voice), vehicle, clock,
                                   std::numeric_limits<std::size_t>::max());
}

std::unique_ptr<Session> runSession(const std::string& folder, const Inputs& inputs, std::size_t most_rows) {
  return std::make_unique<RunShow>(
      folder, inputs, std::nullopt, [] { return Duration{}; }, most_rows);
}

std::unique_ptr<Session> mapSession(const std::string& map) {
  Inputs inputs;
  inputs.map = std::make_shared<const map::TunnelMap>(mapOf(map));
  return std::make_unique<MapShow>(std::move(inputs));
}

}  // namespace pos::app
