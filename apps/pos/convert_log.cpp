#include "convert_log.hpp"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/io/json_lines.hpp"
#include "pos/io/log_cache.hpp"
#include "pos/io/mcap_log.hpp"
#include "pos/io/rawlog_writer.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct LogOptions {
  std::string in;
  std::string out;
  std::string to;
  std::vector<std::string> mounts;
};

/// What to write, as told or by the ending of the file's name.
std::string formOf(const LogOptions& options) {
  if (!options.to.empty()) return options.to;
  const std::string ending = fs::path(options.out).extension().string();
  if (options.out == "-" || ending == ".jsonl") return "jsonl";
  if (ending == ".mcap") return "mcap";
  if (ending == ".cache") return "cache";
  return "rawlog";
}

/// "FRAME=X,Y,Z,YAW,PITCH,ROLL", metres and degrees.
std::pair<std::string, Pose3> mountFrom(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::vector<std::string> parts =
      CLI::detail::split(equals == std::string::npos ? "" : text.substr(equals + 1), ',');
  std::array<double, 6> v{};
  bool good = equals != std::string::npos && equals > 0 && parts.size() == v.size();
  for (std::size_t i = 0; good && i < v.size(); ++i) {
    const auto number = io::text::number(parts[i]);
    good = number.has_value();
    v[i] = number.value_or(0.0);
  }
  if (!good) {
    throw UsageError(Complaint{.what = "this is no place of a sensor on the vehicle",
                               .key = "--mount",
                               .got = text,
                               .expected = "FRAME=X,Y,Z,YAW,PITCH,ROLL in metres and degrees, such as "
                                           "laser=1.2,0,0.8,0,0,0"});
  }
  return {text.substr(0, equals),
          Pose3::fromXyzYawPitchRoll(v[0], v[1], v[2], radians(v[3]), radians(v[4]), radians(v[5]))};
}

std::unique_ptr<io::LogReader> openFor(const LogOptions& options) {
  if (options.mounts.empty()) return io::openLogItself(options.in);
  if (!io::isMcap(options.in)) {
    throw UsageError(Complaint{.what = "only the frames of an MCAP file can be placed on the vehicle",
                               .key = "--mount",
                               .got = options.in});
  }
  io::Mounts mounts;
  for (const std::string& text : options.mounts) mounts.insert(mountFrom(text));
  return std::make_unique<io::McapLogReader>(options.in, std::move(mounts));
}

/// Every measurement into `writer`, which is closed then.
template <class Writer>
io::CopiedLog copied(io::LogReader& reader, Writer writer) {
  io::CopiedLog result;
  for (; auto measurement = reader.next(); ++result.measurements) writer.write(*measurement);
  writer.close();
  result.end = reader.end();
  result.tally = reader.tally();
  return result;
}

/// JSON lines, into a file or onto standard output.
class JsonLines {
 public:
  explicit JsonLines(const std::string& out) {
    if (out != "-") file_.emplace(out);
  }
  void write(const Measurement& measurement) {
    const std::string line = io::jsonLine(measurement);
    if (file_) return file_->write(line);
    print(line + "\n");
  }
  void close() {
    if (file_) file_->close();
  }

 private:
  std::optional<io::LineWriter> file_;
};

io::CopiedLog convertedLog(const LogOptions& options, const std::string& form, const std::string& out) {
  if (form == "cache" && options.mounts.empty()) return io::packLog(options.in, out);
  if (form == "cache") {
    throw UsageError(Complaint{.what = "a packed copy is of the log as it is",
                               .key = "--mount",
                               .suggestion = "convert to a rawlog with --mount first, then pack that"});
  }
  const std::unique_ptr<io::LogReader> reader = openFor(options);
  if (form == "jsonl") return copied(*reader, JsonLines(out));
  if (form == "mcap") return copied(*reader, io::McapLogWriter(out));
  return copied(*reader, io::RawlogWriter(out));
}

ExitCode convertLog(const LogOptions& options, const Voice& voice) {
  const std::string form = formOf(options);
  const std::string out =
      options.out.empty() && form == "cache" ? io::cacheBeside(options.in).string() : options.out;
  if (out.empty()) {
    throw UsageError(Complaint{.what = "the file to write is not named",
                               .key = "--out",
                               .expected = "a file named *.rawlog, *.jsonl, *.mcap or *.cache"});
  }
  const io::CopiedLog result = convertedLog(options, form, out);
  for (const auto& [what, n] : result.tally.skipped)
    voice.warn("not converted, pos has no such reading: " + std::to_string(n) + " x " + what);
  for (const auto& [what, n] : result.tally.refused)
    voice.warn("not converted: " + std::to_string(n) + " x " + what);
  voice.say(std::to_string(result.measurements) + " measurements written" + (out == "-" ? "" : " to " + out));
  if (result.end.damaged) voice.warn("the source is damaged: " + result.end.message);
  return result.end.damaged ? ExitCode::Data : ExitCode::Ok;
}

}  // namespace

void addConvertLog(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand(
      "log",
      "A log (rawlog, MCAP) into a rawlog, JSON lines, an MCAP file, or a packed copy that is read faster");
  auto options = std::make_shared<LogOptions>();
  verb->add_option("in", options->in, "Log to read")->required();
  verb->add_option(
      "--out", options->out,
      "File to write; *.jsonl, or - for standard output: JSON lines; *.mcap; *.cache. Packed copies go "
      "beside the log where no file is named");
  verb->add_option("--to", options->to, "What to write, where the ending of --out does not tell")
      ->check(CLI::IsMember({"rawlog", "jsonl", "mcap", "cache"}));
  verb->add_option("--mount", options->mounts,
                   "FRAME=X,Y,Z,YAW,PITCH,ROLL (m, degrees): where an MCAP file's frame sits on the vehicle")
      ->take_all()
      ->allow_extra_args(false);
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = convertLog(*options, *verbs.voice); });
}

}  // namespace pos::app
