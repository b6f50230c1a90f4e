#pragma once
/// One thing that `pos serve` shows: a finished run, a replay in progress, a live feed, or a map alone.

#include <exception>
#include <functional>
#include <memory>

#include "pos/io/run_folder.hpp"
#include "pos/serve/command.hpp"
#include "pos/serve/connections.hpp"
#include "serve_stage.hpp"

namespace pos::app {

/// Time since some moment of the machine's clock; it never goes back.
using Clock = std::function<Duration()>;

class Session {
 public:
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(Session&&) = delete;
  virtual ~Session() = default;  ///< ends its threads

  virtual Stage& stage() = 0;
  /// The picture of this moment. Never waits for an estimator.
  virtual serve::Show show() = 0;
  /// The picture of another moment. Throws RequestError where only this moment is known.
  virtual serve::Show showAt(Stamp stamp);
  /// Throws RequestError for a command that has no meaning here.
  virtual void command(const serve::Command& command) = 0;
  /// What ended the show early, or null.
  virtual std::exception_ptr fault() { return nullptr; }
  /// The map of the inputs, where it is a file.
  std::optional<std::filesystem::path> mapFile() const { return map_file_; }
  /// Files of the run, if it is one.
  virtual const std::filesystem::path* folder() const { return nullptr; }

 protected:
  void setMapFile(const Inputs& inputs);

 private:
  std::optional<std::filesystem::path> map_file_;
};

/// `vehicle` shows the locks along its route.
std::unique_ptr<Session> runSession(const std::string& folder, const std::optional<LockedVehicle>& vehicle,
                                    const Clock& clock, const Voice& voice);
/// The same where the inputs of the run are at hand, for a look at it without a clock, with at most so many
/// evenly spread rows of each estimator in memory.
std::unique_ptr<Session> runSession(const std::string& folder, const Inputs& inputs, std::size_t most_rows);

struct ReplayOptions {
  bool play = false;                          ///< begins by itself
  std::optional<LockedVehicle> vehicle = {};  ///< shows the locks along its route
  serve::ConnectionRules connections = {};
};
std::unique_ptr<Session> replaySession(Inputs inputs, const ReplayOptions& options, const Clock& clock);

struct LiveOptions {
  std::string folder = {};      ///< for the recording
  bool standard_input = false;  ///< JSON lines come there
  std::optional<int> tcp = {};  ///< or at this port
  std::string address = "127.0.0.1";
  std::optional<LockedVehicle> vehicle = {};  ///< shows the locks along its route
  serve::ConnectionRules connections = {};
};
std::unique_ptr<Session> liveSession(Inputs inputs, const LiveOptions& options, const Clock& clock,
                                     const Voice& voice);

std::unique_ptr<Session> mapSession(const std::string& map);

/// Throws RequestError 409.
[[noreturn]] void refuseInThisMode(const std::string& what);

}  // namespace pos::app
