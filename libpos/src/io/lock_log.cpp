#include "pos/io/lock_log.hpp"

#include <algorithm>
#include <map>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

using namespace interval;
using text::shortest;

constexpr std::size_t kStamp = 0;
constexpr std::size_t kRow = 1;
constexpr std::size_t kKind = 2;
constexpr std::size_t kVehicle = 3;
constexpr std::size_t kDetail = 4;

bool same(const Way& a, const Way& b) {
  const auto equal_section = [](const WaySection& x, const WaySection& y) {
    return x.section == y.section && x.movement == y.movement && x.from == y.from && x.to == y.to;
  };
  const auto equal_stop = [](const WayStop& x, const WayStop& y) {
    return x.stop == y.stop && x.at == y.at && x.from == y.from && x.to == y.to;
  };
  return std::equal(a.sections.begin(), a.sections.end(), b.sections.begin(), b.sections.end(),
                    equal_section) &&
         std::equal(a.stops.begin(), a.stops.end(), b.stops.begin(), b.stops.end(), equal_stop);
}

const char* kindOf(const LockEvent& event) {
  static constexpr std::array kNames{"enrol",  "begin", "request", "withdraw", "report",
                                     "parked", "tick",  "restart", "announce", "override"};
  static_assert(kNames.size() == std::variant_size_v<decltype(LockEvent::what)>);
  return kNames[event.what.index()];
}

VehicleId vehicleOf(const LockEvent& event) {
  return std::visit(
      [](const auto& e) -> VehicleId {
        if constexpr (requires { e.vehicle; }) return e.vehicle;
        return -1;
      },
      event.what);
}

std::string number(std::size_t value) {
  return std::to_string(value);
}

std::string recordDetail(const LockRecord& r) {
  using Kind = LockRecord::Kind;
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += (text.empty() ? "" : ";") + std::string(key) + "=" + value;
  };
  const bool road = r.kind == Kind::Locked || r.kind == Kind::Released || r.kind == Kind::Trespass;
  const bool place = r.kind == Kind::Granted || r.kind == Kind::SlotTaken || r.kind == Kind::SlotFreed;
  if (road) add("section", number(r.section));
  if (road) add("movement", std::to_string(r.movement));
  if (place) add("stop", number(r.stop));
  if (r.other >= 0) add("other", std::to_string(r.other));
  if (!r.reason.empty()) add("reason", r.reason);
  return text;
}

/// key=value;key=value of a cell; `reason` and `why` come last and take the rest.
class Details {
 public:
  Details(const CsvReader& table) : table_(table) {
    std::string_view left = table.cell(kDetail);
    while (!left.empty()) {
      const std::size_t equals = left.find('=');
      if (equals == std::string_view::npos) table.refuse(kDetail, "a detail has no value", "key=value;...");
      const std::string key(left.substr(0, equals));
      left.remove_prefix(equals + 1);
      const bool last = key == "reason" || key == "why";
      const std::size_t end = last ? left.size() : std::min(left.find(';'), left.size());
      values_[key] = std::string(left.substr(0, end));
      left.remove_prefix(std::min(end + 1, left.size()));
    }
  }

  bool has(const std::string& key) const { return values_.count(key) != 0; }
  std::string text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) table_.refuse(kDetail, "the row lacks " + key, key + "=...");
    return found->second;
  }
  double number(const std::string& key) const {
    const auto value = text::number(text(key));
    if (!value) table_.refuse(kDetail, key + " is no number", "a number");
    return *value;
  }
  int whole(const std::string& key) const {
    const auto value = text::integer(text(key));
    if (!value || *value < -1'000'000'000 || *value > 1'000'000'000)
      table_.refuse(kDetail, key + " is no whole number", "a whole number");
    return static_cast<int>(*value);
  }
  std::size_t index(const std::string& key) const {
    const int value = whole(key);
    if (value < 0) table_.refuse(kDetail, key + " is negative", "0 or more");
    return static_cast<std::size_t>(value);
  }

 private:
  const CsvReader& table_;
  std::map<std::string, std::string> values_;
};

Way wayAt(const CsvReader& table, const Details& detail, const std::vector<Way>& ways) {
  if (!detail.has("way")) return {};
  const std::size_t index = detail.index("way");
  if (index >= ways.size()) table.refuse(kDetail, "there is no such way", "a way of the scene");
  return ways[index];
}

LockEvent eventFrom(const CsvReader& table, const std::vector<Way>& ways) {
  const std::string kind(table.cell(kKind));
  const Details d(table);
  LockEvent event{.stamp = Stamp(table.duration(kStamp, text::TimeUnit::Seconds))};
  const auto vehicle = static_cast<VehicleId>(table.integer(kVehicle));
  if (kind == "enrol") {
    event.what = Enrol{vehicle, d.number("front_m"), d.number("rear_m"), d.number("max_speed_m_per_s"),
                       d.whole("priority")};
  } else if (kind == "begin") {
    event.what = Begin{vehicle, wayAt(table, d, ways)};
  } else if (kind == "request") {
    event.what = Request{vehicle};
  } else if (kind == "withdraw") {
    event.what = Withdraw{vehicle};
  } else if (kind == "report") {
    Report report{.vehicle = vehicle, .distance = d.number("distance_m"), .sigma = d.number("sigma_m")};
    if (d.has("speed_m_per_s")) report.speed = d.number("speed_m_per_s");
    if (d.has("alarm")) report.integrity = Report::Integrity::Alarm;
    if (d.has("passage")) report.evidence = Report::Evidence::Passage;
    event.what = report;
  } else if (kind == "parked") {
    event.what = Parked{vehicle, d.index("stop")};
  } else if (kind == "tick") {
    event.what = Tick{};
  } else if (kind == "restart") {
    event.what = Restart{};
  } else if (kind == "announce") {
    event.what =
        Announce{vehicle, wayAt(table, d, ways), d.index("stop"), d.number("rear_limit_m"), d.has("parked")};
  } else if (kind == "override") {
    const bool trust = d.text("action") == "trust";
    event.what = Override{trust ? Override::Action::Trust : Override::Action::Remove, vehicle, d.text("who"),
                          d.text("why")};
  } else {
    table.refuse(kKind, "no event is called that", "enrol, begin, request, withdraw, report, ...");
  }
  return event;
}

LockRecord recordFrom(const CsvReader& table) {
  using Kind = LockRecord::Kind;
  const std::string_view word = table.cell(kKind);
  const Details d(table);
  LockRecord record{.stamp = Stamp(table.duration(kStamp, text::TimeUnit::Seconds)),
                    .vehicle = static_cast<VehicleId>(table.integer(kVehicle))};
  bool found = false;
  for (int k = 0; k <= static_cast<int>(Kind::Rejected) && !found; ++k) {
    record.kind = static_cast<Kind>(k);
    found = name(record.kind) == word;
  }
  if (!found) table.refuse(kKind, "no record is called that", "granted, refused, locked, released, ...");
  if (d.has("section")) record.section = d.index("section");
  if (d.has("movement")) record.movement = d.whole("movement");
  if (d.has("stop")) record.stop = d.index("stop");
  if (d.has("other")) record.other = d.whole("other");
  if (d.has("reason")) record.reason = d.text("reason");
  return record;
}

}  // namespace

LockLogWriter::LockLogWriter(const std::filesystem::path& path, std::vector<Way> ways)
    : lines_(path), ways_(std::move(ways)) {
  lines_.write("stamp_s,row,kind,vehicle,detail");
}

std::string LockLogWriter::wayNumber(const Way& way) const {
  const auto found = std::find_if(ways_.begin(), ways_.end(), [&](const Way& w) { return same(w, way); });
  if (found == ways_.end())
    throw DataError(Complaint{.what = "a vehicle drives a way that is not in the scene"});
  return std::to_string(found - ways_.begin());
}

std::string LockLogWriter::detail(const LockEvent& event) const {
  if (const auto* e = std::get_if<Enrol>(&event.what)) {
    return "front_m=" + shortest(e->front) + ";rear_m=" + shortest(e->rear) +
           ";max_speed_m_per_s=" + shortest(e->max_speed) + ";priority=" + std::to_string(e->priority);
  }
  if (const auto* e = std::get_if<Begin>(&event.what)) return "way=" + wayNumber(e->way);
  if (const auto* e = std::get_if<Report>(&event.what)) {
    std::string text = "distance_m=" + shortest(e->distance) + ";sigma_m=" + shortest(e->sigma);
    if (e->speed) text += ";speed_m_per_s=" + shortest(*e->speed);
    if (e->integrity == Report::Integrity::Alarm) text += ";alarm=1";
    if (e->evidence == Report::Evidence::Passage) text += ";passage=1";
    return text;
  }
  if (const auto* e = std::get_if<Parked>(&event.what)) return "stop=" + number(e->stop);
  if (const auto* e = std::get_if<Announce>(&event.what)) {
    return (e->way.stops.empty() ? "" : "way=" + wayNumber(e->way) + ";") + "stop=" + number(e->stop) +
           ";rear_limit_m=" + shortest(e->rear_limit) + (e->parked ? ";parked=1" : "");
  }
  if (const auto* e = std::get_if<Override>(&event.what)) {
    const std::string action = e->action == Override::Action::Trust ? "trust" : "remove";
    return "action=" + action + ";who=" + e->who + ";why=" + e->why;
  }
  return "";
}

void LockLogWriter::write(const LockEvent& event, const std::vector<LockRecord>& records) {
  const std::string stamp = text::stampSeconds(event.stamp);
  lines_.write(stamp + ",event," + kindOf(event) + "," + std::to_string(vehicleOf(event)) + "," +
               text::csvCell(detail(event)));
  for (const LockRecord& record : records) {
    lines_.write(text::stampSeconds(record.stamp) + ",record," + std::string(name(record.kind)) + "," +
                 std::to_string(record.vehicle) + "," + text::csvCell(recordDetail(record)));
  }
}

LockLogReader::LockLogReader(const std::filesystem::path& path, std::vector<Way> ways)
    : table_(path), ways_(std::move(ways)) {
  const std::vector<std::string> wanted{"stamp_s", "row", "kind", "vehicle", "detail"};
  if (table_.columns() != wanted) {
    throw DataError(Complaint{.what = "this is no log of locks",
                              .place = {.file = table_.file()},
                              .got = text::joined(table_.columns()),
                              .expected = text::joined(wanted)});
  }
  pending_ = table_.next();
}

std::optional<LockStep> LockLogReader::next() {
  if (!pending_) return std::nullopt;
  if (table_.cell(kRow) != "event") table_.refuse(kRow, "a record comes before its event", "event");
  LockStep step{.event = eventFrom(table_, ways_), .records = {}};
  while ((pending_ = table_.next()) && table_.cell(kRow) == "record")
    step.records.push_back(recordFrom(table_));
  return step;
}

}  // namespace pos::io
