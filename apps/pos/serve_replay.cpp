/// A log or scenario through the estimators at the pace of a playhead.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <thread>

#include "pos/serve/request.hpp"
#include "serve_playing.hpp"
#include "serve_session.hpp"
#include "source.hpp"

namespace pos::app {
namespace {

constexpr std::size_t kSlice = 256;                       // measurements between looks at the commands
constexpr Duration kRest = std::chrono::milliseconds(5);  // while waiting for the playhead
constexpr Duration kModesEvery = std::chrono::milliseconds(50);
constexpr Duration kBehind = std::chrono::milliseconds(500);  // of the machine's clock

/// Stamps of the log's ends. With a truth they are known; otherwise the log is read once.
struct Ends {
  std::optional<Stamp> first;
  std::optional<Stamp> last;
};
Ends spanOf(const Inputs& inputs) {
  Ends span;
  if (inputs.truth && !inputs.truth->poses.empty())
    return {inputs.truth->poses.front().stamp, inputs.truth->poses.back().stamp};
  const auto source = openSource(inputs);
  while (const auto measurement = source->next()) {
    span.first = span.first ? std::min(*span.first, measurement->stamp) : measurement->stamp;
    span.last = span.last ? std::max(*span.last, measurement->stamp) : measurement->stamp;
  }
  return span;
}

class ReplayShow final : public Session {
 public:
  ReplayShow(Inputs inputs, const ReplayOptions& options, const Clock& clock)
      : inputs_(std::move(inputs)),
        clock_(clock),
        stage_(sceneryOf(inputs_, serve::Mode::Replay, options.vehicle)),
        monitor_(options.connections, stage_.scenery().anchors),
        playhead_(Stamp{}) {
    setMapFile(inputs_);
    const Ends span = spanOf(inputs_);
    stage_.setSpan(span.first, span.last);
    reached_ = begin();
    ended_ = !next_;
    playhead_ = serve::Playhead(span.first.value_or(reached_));
    if (options.play) playhead_.play(clock_());
    thread_ = std::thread([this] { run(); });
  }

  ~ReplayShow() override {
    stopping_ = true;
    woken_.notify_all();
    thread_.join();
  }
  ReplayShow(const ReplayShow&) = delete;
  ReplayShow& operator=(const ReplayShow&) = delete;
  ReplayShow(ReplayShow&&) = delete;
  ReplayShow& operator=(ReplayShow&&) = delete;

  Stage& stage() override { return stage_; }
  std::exception_ptr fault() override {
    const std::lock_guard lock(mutex_);
    return fault_;
  }

  serve::Show show() override {
    serve::Show show{.mode = serve::Mode::Replay, .first = stage_.first(), .last = stage_.last()};
    {
      const std::lock_guard lock(mutex_);
      show.stamp = shown();
      show.playing = playhead_.playing();
      show.speed = playhead_.speed();
      show.seeking = seeking_.has_value();
      show.ended = ended_;
    }
    show.truth = stage_.truthAt(*show.stamp);
    show.estimators = stage_.estimators();
    show.locks = stage_.locks();
    show.connections = monitor_.at(show.stamp->time_since_epoch());
    return show;
  }

  void command(const serve::Command& command) override {
    using Kind = serve::Command::Kind;
    if (command.kind == Kind::Record)
      refuseInThisMode("a replay is not recorded: pos replay --out keeps its results");
    const std::lock_guard lock(mutex_);
    const Duration now = clock_();
    if (command.kind == Kind::Play) {
      if (ended_) seekTo(stage_.first().value_or(Stamp{}), now);
      playhead_.play(now);
    }
    if (command.kind == Kind::Pause) playhead_.pause(now);
    if (command.kind == Kind::Speed) playhead_.setSpeed(command.speed, now);
    if (command.kind == Kind::Seek) seekTo(command.stamp, now);
    woken_.notify_all();
  }

 private:
  /// The moment on the screen: while seeking, how far it has come.
  Stamp shown() const { return seeking_ ? std::min(reached_, *seeking_) : playhead_.at(clock_()); }

  void seekTo(Stamp stamp, Duration now) {
    const Stamp first = stage_.first().value_or(stamp);
    seeking_ = std::clamp(stamp, first, std::max(first, stage_.last().value_or(stamp)));
    if (*seeking_ < reached_) again_ = true;
    playhead_.seek(*seeking_, now);
  }

  /// Everything from the first measurement on; its stamp.
  Stamp begin() {
    pass_.reset();
    stage_.clear();
    monitor_.forget();
    source_ = openSource(inputs_);
    pass_ = passOnStage(inputs_, nullptr, stage_, monitor_,
                        [](const Measurement& m) { return m.stamp.time_since_epoch(); });
    next_ = source_->next();
    return next_ ? next_->stamp : Stamp{};
  }

  void run() {
    try {
      playAll();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      fault_ = std::current_exception();
    }
  }

  void playAll() {
    while (!stopping_) {
      std::unique_lock lock(mutex_);
      if (again_) {
        again_ = false;
        lock.unlock();
        const Stamp first = begin();
        lock.lock();
        reached_ = first;
        ended_ = !next_;
      }
      const Stamp target = seeking_.value_or(playhead_.at(clock_()));
      if (due(target)) {
        lock.unlock();
        feed(target);
        continue;
      }
      settle(target);
      woken_.wait_for(lock, kRest);
    }
  }

  bool due(Stamp target) const { return next_ && next_->stamp <= target; }

  void feed(Stamp target) {
    Stamp reached = reached_;
    for (std::size_t i = 0; i < kSlice && due(target) && !stopping_; ++i) {
      reached = std::max(reached, next_->stamp);
      monitor_.arrived(*next_, next_->stamp.time_since_epoch());
      pass_->take(std::move(*next_));
      next_ = source_->next();
    }
    if (!next_) pass_->finish();
    const Duration now = clock_();
    if (now - modes_shown_ >= kModesEvery || !next_) {
      showModes(*pass_, stage_);
      modes_shown_ = now;
    }
    const std::lock_guard lock(mutex_);
    reached_ = reached;
    if (!next_) noteEnd();
    keepPace(now);
  }

  void noteEnd() {
    const io::LogEnd end = source_->end();
    if (end.damaged && !ended_) stage_.event({reached_, "", "log_damaged", "", end.message});
    ended_ = true;
  }

  /// Where the estimators are slower than the playhead, it waits for them.
  void keepPace(Duration now) {
    if (seeking_ || !next_ || !playhead_.playing()) return;
    const double behind = seconds(playhead_.at(now) - next_->stamp) / playhead_.speed();
    if (behind > seconds(kBehind)) playhead_.seek(next_->stamp, now);
  }

  /// All that was due has been played.
  void settle(Stamp target) {
    if (seeking_ == target) {
      playhead_.seek(target, clock_());
      seeking_.reset();
      showModes(*pass_, stage_);
    }
    if (!next_ && playhead_.playing() && playhead_.at(clock_()) >= reached_) {
      playhead_.pause(clock_());
      playhead_.seek(std::max(reached_, std::min(target, stage_.last().value_or(reached_))), clock_());
    }
    if (next_) ended_ = false;
  }

  const Inputs inputs_;
  Clock clock_;
  Stage stage_;
  serve::ConnectionMonitor monitor_;
  std::unique_ptr<Source> source_;  // with pass_ and next_: of the playing thread alone
  std::unique_ptr<Pass> pass_;
  std::optional<Measurement> next_;
  Duration modes_shown_ = {};

  std::mutex mutex_;  // guards what follows; never held while an estimator works
  std::condition_variable woken_;
  serve::Playhead playhead_;
  std::optional<Stamp> seeking_;
  bool again_ = false;
  bool ended_ = false;
  Stamp reached_ = {};
  std::exception_ptr fault_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Session> replaySession(Inputs inputs, const ReplayOptions& options, const Clock& clock) {
  return std::make_unique<ReplayShow>(std::move(inputs), options, clock);
}

}  // namespace pos::app
