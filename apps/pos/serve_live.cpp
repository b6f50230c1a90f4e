/// Live measurements through the estimators, recorded while they are shown.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <thread>

#include "outputs.hpp"
#include "pos/core/error.hpp"
#include "pos/io/append_file.hpp"
#include "pos/io/rawlog_tape.hpp"
#include "pos/serve/request.hpp"
#include "serve_feed.hpp"
#include "serve_playing.hpp"
#include "serve_session.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kQueue = 65536;                             // measurements that may wait
constexpr Duration kFlushEvery = std::chrono::milliseconds(500);  // half of what may be lost
constexpr Duration kRest = std::chrono::milliseconds(20);
constexpr std::uint64_t kBadLinesTold = 100;

/// A rawlog under way. Each file has a tape of its own, so that each can be read by itself.
class Tape {
 public:
  explicit Tape(fs::path folder) : folder_(std::move(folder)) { begin(); }

  void begin() {
    if (file_) return;
    ++number_;
    name_ = number_ == 1 ? "log.rawlog" : "log-" + std::to_string(number_) + ".rawlog";
    tape_ = io::RawlogTape();
    file_.emplace(folder_ / name_);
    measurements_ = bytes_ = 0;
  }
  void end() {
    if (file_) file_->close();
    file_.reset();
  }
  /// What the estimators get; recorded before they see it.
  std::vector<Measurement> take(const Measurement& measurement) {
    io::Taped taped = tape_.take(measurement);
    if (file_) {
      file_->append(taped.bytes);
      bytes_ = file_->bytes();
      ++measurements_;
    }
    return std::move(taped.read_back);
  }
  void flush() {
    if (file_) file_->flush();
  }
  serve::Recording recording() const { return {file_.has_value(), name_, measurements_, bytes_}; }

 private:
  fs::path folder_;
  int number_ = 0;
  std::string name_;
  io::RawlogTape tape_;
  std::optional<io::AppendFile> file_;
  std::uint64_t measurements_ = 0;
  std::uint64_t bytes_ = 0;
};

class LiveShow final : public Session {
 public:
  LiveShow(Inputs inputs, const LiveOptions& options, const Clock& clock, const Voice& voice)
      : inputs_(std::move(inputs)),
        clock_(clock),
        folder_(io::RunFolder::create(options.folder, io::ExistingRun::Refuse)),
        stage_(sceneryOf(inputs_, serve::Mode::Live, options.vehicle)),
        monitor_(options.connections, stage_.scenery().anchors),
        tape_(options.folder),
        feed_(
            {.measurement = [this](Measurement m) { arrive(std::move(m)); },
             .bad_line = [this](const std::string& text, const std::string& sensor) { refuse(text, sensor); },
             .ended = [this] { input_ended_ = true; }}) {
    setMapFile(inputs_);
    writeFile(folder_.path() / "config.yaml", io::resolvedYaml(inputs_.config));
    pass_ = passOnStage(inputs_, &folder_, stage_, monitor_, [this](const Measurement&) { return clock_(); });
    recording_ = tape_.recording();
    thread_ = std::thread([this] { run(); });
    watcher_ = std::thread([this] { watch(); });
    if (options.standard_input) feed_.readStandardInput();
    if (options.tcp) {
      const int port = feed_.listen(options.address, *options.tcp);
      voice.say("live feed: JSON lines on TCP " + options.address + ":" + std::to_string(port));
    }
  }

  ~LiveShow() override {
    stopping_ = true;
    woken_.notify_all();
    room_.notify_all();
    watcher_.join();
    thread_.join();
  }
  LiveShow(const LiveShow&) = delete;
  LiveShow& operator=(const LiveShow&) = delete;
  LiveShow(LiveShow&&) = delete;
  LiveShow& operator=(LiveShow&&) = delete;

  Stage& stage() override { return stage_; }
  std::exception_ptr fault() override {
    const std::lock_guard lock(mutex_);
    return fault_;
  }

  serve::Show show() override {
    serve::Show show{.mode = serve::Mode::Live,
                     .playing = true,
                     .ended = input_ended_,
                     .first = stage_.first(),
                     .estimators = stage_.estimators(),
                     .locks = stage_.locks(),
                     .connections = monitor_.at(clock_()),
                     .refused_lines = refused_lines_};
    const std::lock_guard lock(mutex_);
    show.stamp = newest_;
    show.truth = truth_;
    show.recording = recording_;
    return show;
  }

  void command(const serve::Command& command) override {
    if (command.kind != serve::Command::Kind::Record)
      refuseInThisMode("a live feed cannot be paused, moved or hurried");
    std::unique_lock lock(mutex_);
    if (command.on == recording_.on) return;
    wanted_ = command.on;
    woken_.notify_all();
    settled_.wait_for(lock, std::chrono::seconds(2), [&] { return !wanted_ || stopping_; });
  }

 private:
  /// By a feeding thread. A full queue makes its sender wait, and nobody else.
  void arrive(Measurement measurement) {
    monitor_.arrived(measurement, clock_());
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return queue_.size() < kQueue || stopping_; });
    queue_.push_back(std::move(measurement));
    woken_.notify_all();
  }

  void refuse(const std::string& text, const std::string& sensor) {
    monitor_.refused(sensor, text, clock_());
    const std::uint64_t count = ++refused_lines_;
    if (count > kBadLinesTold) return;
    const bool last = count == kBadLinesTold;
    stage_.event({newest(), "", "bad_line", "", text + (last ? " (further ones are only counted)" : "")});
  }

  Stamp newest() {
    const std::lock_guard lock(mutex_);
    return newest_.value_or(Stamp{});
  }

  void run() {
    try {
      playAll();
    } catch (...) {  // a full disk: told by whoever asks for the fault
      const std::lock_guard lock(mutex_);
      fault_ = std::current_exception();
    }
  }

  void playAll() {
    for (bool more = true; more;) {
      const std::deque<Measurement> batch = nextBatch();
      for (const Measurement& measurement : batch) play(measurement);
      keep();
      more = !batch.empty() || !stopping_;
    }
    (void)pass_->finished({});
    tape_.end();
    writeRunJson(folder_, inputs_);
  }

  std::deque<Measurement> nextBatch() {
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, kRest, [&] { return !queue_.empty() || wanted_ || stopping_; });
    std::deque<Measurement> batch;
    for (std::size_t i = 0; i < 256 && !queue_.empty(); ++i) {
      batch.push_back(std::move(queue_.front()));
      queue_.pop_front();
    }
    room_.notify_all();
    return batch;
  }

  void play(const Measurement& measurement) {
    const std::vector<Measurement> read_back = tape_.take(measurement);
    if (read_back.empty())
      monitor_.refused(measurement.sensor, "out of the range of the recording", clock_());
    for (const Measurement& m : read_back) {
      if (const auto* truth = std::get_if<PoseTruth>(&m.reading)) showTruth({m.stamp, truth->T_map_body});
      pass_->take(m);
    }
    const std::lock_guard lock(mutex_);
    if (!newest_) stage_.setSpan(measurement.stamp, std::nullopt);
    newest_ = std::max(newest_.value_or(measurement.stamp), measurement.stamp);
  }

  void showTruth(const TruthPose& pose) {
    stage_.truth(pose);
    const std::lock_guard lock(mutex_);
    truth_ = pose.T_map_body;
  }

  /// What is due now and then: the disk, the commands, the models.
  void keep() {
    const Duration now = clock_();
    const bool due = now - flushed_ >= kFlushEvery;
    if (due) {
      tape_.flush();
      pass_->flush();
      flushed_ = now;
    }
    if (due || now - modes_shown_ >= std::chrono::milliseconds(50)) {
      showModes(*pass_, stage_);
      modes_shown_ = now;
    }
    const std::lock_guard lock(mutex_);
    if (wanted_) {
      *wanted_ ? tape_.begin() : tape_.end();
      stage_.event({newest_.value_or(Stamp{}), "", *wanted_ ? "recording_on" : "recording_off", "",
                    tape_.recording().file});
      wanted_.reset();
      settled_.notify_all();
    }
    recording_ = tape_.recording();
  }

  /// The watch over the connections has a thread of its own: an estimator that hangs does not stop it.
  void watch() {
    while (!stopping_) {
      for (const serve::ConnectionChange& change : monitor_.changes(clock_())) {
        const char* kind = change.state == serve::Connection::Stale  ? "source_stale"
                           : change.state == serve::Connection::Lost ? "source_lost"
                                                                     : "source_back";
        stage_.event({newest(), "", kind, change.source, "silent for " + std::to_string(change.age) + " s"});
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  const Inputs inputs_;
  Clock clock_;
  io::RunFolder folder_;
  Stage stage_;
  serve::ConnectionMonitor monitor_;
  std::unique_ptr<Pass> pass_;  // with the tape: of the playing thread alone
  Tape tape_;
  Duration flushed_ = {};
  Duration modes_shown_ = {};

  std::mutex mutex_;  // guards what follows; never held while an estimator works
  std::condition_variable woken_;
  std::condition_variable room_;
  std::condition_variable settled_;
  std::deque<Measurement> queue_;
  std::optional<Stamp> newest_;
  std::optional<Pose3> truth_;
  serve::Recording recording_;
  std::optional<bool> wanted_;
  std::exception_ptr fault_;
  std::atomic<std::uint64_t> refused_lines_{0};
  std::atomic<bool> input_ended_{false};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
  std::thread watcher_;
  Feed feed_;  // last in, first out: its threads call the rest
};

}  // namespace

std::unique_ptr<Session> liveSession(Inputs inputs, const LiveOptions& options, const Clock& clock,
                                     const Voice& voice) {
  return std::make_unique<LiveShow>(std::move(inputs), options, clock, voice);
}

}  // namespace pos::app
