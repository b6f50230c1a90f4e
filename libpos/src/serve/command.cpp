#include "pos/serve/command.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "pos/io/text.hpp"
#include "pos/serve/request.hpp"

namespace pos::serve {
namespace {

using Json = nlohmann::json;

constexpr double kSlowest = 0.1;
constexpr double kFastest = 1000.0;
constexpr double kLatest = 4.6e9;  // s, what fits a stamp

Json objectOf(std::string_view text) {
  // Nothing of a command is nested; the callback keeps a deep text from being built.
  const Json json = Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth <= 1; }, false);
  if (json.is_object()) return json;
  throw badRequest(Complaint{.what = "the body is no JSON object", .expected = "{\"do\": \"play\"}"});
}

double numberIn(const Json& json, const char* key, double min, double max) {
  const auto found = json.find(key);
  if (found != json.end() && found->is_number()) {
    const double value = found->get<double>();
    if (value >= min && value <= max) return value;
  }
  throw badRequest(
      Complaint{.what = "the value is missing, no number, or out of range",
                .key = key,
                .expected = "a number from " + io::text::shortest(min) + " to " + io::text::shortest(max)});
}

bool flagIn(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found != json.end() && found->is_boolean()) return found->get<bool>();
  throw badRequest(Complaint{.what = "the value is missing or neither true nor false", .key = key});
}

void requireKeys(const Json& json, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : json.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw badRequest(Complaint{.what = "this command has no such key", .key = key});
  }
}

}  // namespace

Command parsedCommand(std::string_view text) {
  const Json json = objectOf(text);
  const auto verb = json.find("do");
  const std::string word = verb != json.end() && verb->is_string() ? verb->get<std::string>() : "";
  if (word == "play" || word == "pause") {
    requireKeys(json, {"do"});
    return {.kind = word == "play" ? Command::Kind::Play : Command::Kind::Pause};
  }
  if (word == "seek") {
    requireKeys(json, {"do", "stamp_s"});
    return {.kind = Command::Kind::Seek,
            .stamp = stampFromSeconds(numberIn(json, "stamp_s", -kLatest, kLatest))};
  }
  if (word == "speed") {
    requireKeys(json, {"do", "speed"});
    return {.kind = Command::Kind::Speed, .speed = numberIn(json, "speed", kSlowest, kFastest)};
  }
  if (word == "record") {
    requireKeys(json, {"do", "on"});
    return {.kind = Command::Kind::Record, .on = flagIn(json, "on")};
  }
  throw badRequest(
      Complaint{.what = "there is no such command",
                .key = "do",
                .got = word,
                .expected = "one of: play, pause, seek, speed, record",
                .suggestion = io::text::didYouMean(word, {"play", "pause", "seek", "speed", "record"})});
}

Stamp Playhead::at(Duration now) const {
  if (!playing_) return stamp_;
  return stamp_ + Duration{std::llround(speed_ * static_cast<double>((now - since_).count()))};
}

void Playhead::play(Duration now) {
  seek(at(now), now);
  playing_ = true;
}

void Playhead::pause(Duration now) {
  seek(at(now), now);
  playing_ = false;
}

void Playhead::seek(Stamp stamp, Duration now) {
  stamp_ = stamp;
  since_ = now;
}

void Playhead::setSpeed(double speed, Duration now) {
  seek(at(now), now);
  speed_ = speed;
}

}  // namespace pos::serve
