#pragma once
/// How long an estimator that chooses between models needs when the set of models it can use changes: the
/// model-switching delay of J. China Coal Soc. 2024, doi 10.13225/j.cnki.jccs.2024.0676, section 3, made
/// operational (docs/evaluation.md#switching).
///
///   T1 = the first measurement of a joining model that was taken, or the moment the next one of a leaving
///        model was due and did not come
///   T2 = the first output of the first run of `epochs` outputs in which every model in use has taken a
///        reading since T1, a joining model counts, departed models do not, the leading model stays, and no
///        probability moves by more than `change`
///   delay = T2 - T1; a switch without T2 has failed, and its delay is infinite

#include <optional>
#include <string>
#include <vector>

#include "pos/core/estimate.hpp"

namespace pos::eval {

struct SwitchingRules {
  double on = 0.10;      ///< a joining model counts from this probability on ...
  double off = 0.02;     ///< ... and a departed one does not up to this
  double change = 0.05;  ///< from output to output
  int epochs = 3;
  Duration give_up = durationFromSeconds(2.0);  ///< after T1
};

/// One change of the usable set.
struct ModeSwitch {
  std::string change = {};            ///< "+uwb", "-gnss"
  std::string from = {};              ///< models in use before: "gnss"
  std::string to = {};                ///< and after: "gnss + uwb"
  Stamp started = {};                 ///< T1
  std::optional<Stamp> settled = {};  ///< T2
  /// T2 where a joining model whose readings are the worse ones need not count, as long as the better one
  /// leads: a good filter leaves a bad sensor at its floor.
  std::optional<Stamp> settled_on_better = {};
  std::optional<Stamp> boundary = {};  ///< T0, where the truth of a simulation says when the zone changed

  std::optional<double> delay() const;          ///< s
  std::optional<double> delayToBetter() const;  ///< s
  std::optional<double> wait() const;           ///< s, T1 - T0: for the sensor, not for the filter
};

/// All switches of a run.
struct SwitchingFigures {
  std::vector<ModeSwitch> switches;

  std::size_t failed() const;
  /// Over all switches, s; nothing without switches, infinite when one failed.
  std::optional<double> meanDelay() const;
  std::optional<double> maxDelay() const;
  std::optional<double> meanDelayToBetter() const;
  std::optional<double> maxDelayToBetter() const;
};

/// Follows the outputs of one estimator, in time order.
class SwitchingWatch {
 public:
  explicit SwitchingWatch(const SwitchingRules& rules = {}) : rules_(rules) {}

  void take(Stamp stamp, const std::vector<ModeState>& modes);
  /// `boundaries` upward: moments at which the truth changed zone. A switch belongs to the last one within
  /// `give_up` before its T1.
  SwitchingFigures finish(const std::vector<Stamp>& boundaries = {}) const;

 private:
  /// A run of outputs in which everything holds.
  struct Run {
    int length = 0;
    Stamp first = {};
  };
  void follow(Stamp stamp, const std::vector<ModeState>& modes);
  void begin(const std::vector<ModeState>& modes);
  bool settledAt(const std::vector<ModeState>& modes, bool better_is_enough) const;

  SwitchingRules rules_;
  std::vector<ModeState> before_;
  std::vector<ModeSwitch> switches_;
  bool open_ = false;              // the last switch is still looked at
  std::vector<bool> joined_ = {};  // by mode, in the last switch
  Run strict_;
  Run better_;
};

}  // namespace pos::eval
