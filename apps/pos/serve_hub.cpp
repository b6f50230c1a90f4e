#include "serve_hub.hpp"

#include <nlohmann/json.hpp>

namespace pos::app {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(50);
constexpr Duration kHeartbeat = std::chrono::seconds(1);
constexpr std::size_t kEventsATick = 100;

}  // namespace

void Hub::publish(std::string_view event, std::string_view data) {
  std::string text = "event: ";
  text.append(event).append("\ndata: ").append(data).append("\n\n");
  const std::lock_guard lock(mutex_);
  const bool state = event == "state";
  if (state) last_state_ = text;
  messages_.push_back({std::move(text), state});
  if (messages_.size() > kKept) {
    messages_.pop_front();
    ++first_;
  }
  grown_.notify_all();
}

void Hub::close() {
  closed_ = true;
  grown_.notify_all();
}

Hub::Batch Hub::beginning() {
  const std::lock_guard lock(mutex_);
  return {"retry: 1000\n\n" + last_state_, first_ + messages_.size()};
}

Hub::Batch Hub::after(std::uint64_t from) {
  std::unique_lock lock(mutex_);
  const auto end = [&] { return first_ + messages_.size(); };
  grown_.wait_for(lock, std::chrono::seconds(1), [&] { return closed_ || end() > from; });
  Batch batch{.next = end()};
  if (from < first_) batch.text = "event: reset\ndata: {\"why\":\"slow\"}\n\n";
  std::uint64_t newest_state = 0;
  for (std::uint64_t n = std::max(from, first_); n < end(); ++n) {
    if (messages_[n - first_].state) newest_state = n;
  }
  for (std::uint64_t n = std::max(from, first_); n < end(); ++n) {
    const Message& message = messages_[n - first_];
    if (!message.state || n == newest_state) batch.text += message.text;
  }
  return batch;
}

Ticker::Ticker(Session& session, Hub& hub, const Clock& clock)
    : session_(session),
      hub_(hub),
      clock_(clock),
      events_(session.stage().events()),
      resets_(session.stage().resets()) {
  thread_ = std::thread([this] { run(); });
}

Ticker::~Ticker() {
  stopping_ = true;
  hub_.close();
  thread_.join();
}

std::string Ticker::state() {
  std::string body = serve::stateBody(session_.show(), session_.stage().scenery().names);
  const std::lock_guard lock(mutex_);
  if (body != body_) {
    body_ = std::move(body);
    ++seq_;
  }
  return serve::withSeq(seq_, body_);
}

void Ticker::tellEvents() {
  if (const std::uint64_t resets = session_.stage().resets(); resets != resets_) {
    resets_ = resets;
    events_ = 0;
    hub_.publish("reset", R"({"why":"seek"})");
  }
  if (session_.stage().events() == events_) return;
  const auto fresh = nlohmann::ordered_json::parse(session_.stage().eventsJson(events_, kEventsATick));
  for (const auto& event : fresh.at("events")) {
    hub_.publish("event", event.dump());
    events_ = event.at("n").get<std::uint64_t>() + 1;
  }
}

void Ticker::run() {
  Duration beaten = clock_();
  for (std::uint64_t beats = 0; !stopping_;) {
    tellEvents();
    const std::string text = state();
    if (seq_ != published_) hub_.publish("state", text);
    published_ = seq_;
    if (clock_() - beaten >= kHeartbeat) {
      beaten += kHeartbeat;
      hub_.publish("heartbeat", "{\"n\":" + std::to_string(beats++) + "}");
    }
    std::this_thread::sleep_for(kTick);
  }
}

}  // namespace pos::app
