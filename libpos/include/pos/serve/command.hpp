#pragma once
/// What a person at the screen may ask for, and the place in the log where they are.

#include <string_view>

#include "pos/core/stamp.hpp"

namespace pos::serve {

struct Command {
  enum class Kind { Play, Pause, Seek, Speed, Record };
  Kind kind = Kind::Play;
  Stamp stamp = {};    ///< for Seek
  double speed = 1.0;  ///< for Speed, seconds of log in a second
  bool on = true;      ///< for Record
};
/// Of the body of a POST. Throws RequestError.
Command parsedCommand(std::string_view json);

/// Where in the log the show is, as a function of a clock that the caller reads.
class Playhead {
 public:
  explicit Playhead(Stamp first) : stamp_(first) {}

  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  /// `now` must not decrease from call to call.
  Stamp at(Duration now) const;
  void play(Duration now);
  void pause(Duration now);
  void seek(Stamp stamp, Duration now);
  void setSpeed(double speed, Duration now);

 private:
  Stamp stamp_;          // where it was
  Duration since_ = {};  // when
  double speed_ = 1.0;
  bool playing_ = false;
};

}  // namespace pos::serve
