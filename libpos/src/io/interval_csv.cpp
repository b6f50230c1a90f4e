#include "pos/io/interval_csv.hpp"

#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using interval::IntervalEvent;
using interval::MatchState;
using text::fixed;

const char* word(MatchState state) {
  switch (state) {
    case MatchState::Waiting:
      return "waiting";
    case MatchState::Decided:
      return "decided";
    case MatchState::Branching:
      return "branching";
    case MatchState::Lost:
      return "lost";
  }
  return "";
}

const char* kindOf(IntervalEvent::Kind kind) {
  switch (kind) {
    case IntervalEvent::Kind::Entry:
      return "interval_entry";
    case IntervalEvent::Kind::Exit:
      return "interval_exit";
    case IntervalEvent::Kind::BranchOpen:
      return "branch_open";
    case IntervalEvent::Kind::BranchDecided:
      return "branch_decided";
    case IntervalEvent::Kind::Lost:
      return "road_lost";
    case IntervalEvent::Kind::Found:
      return "road_found";
  }
  return "";
}

}  // namespace

IntervalsCsvWriter::IntervalsCsvWriter(const std::filesystem::path& path, const map::TunnelMap& map,
                                       const std::vector<map::LockInterval>& intervals)
    : lines_(path) {
  for (const map::Roadway& roadway : map.roadways) roadways_.push_back(roadway.id);
  for (const map::LockInterval& interval : intervals) ids_.push_back(interval.id);
  lines_.write(
      "stamp_s,state,roadway,chainage_m,offset_m,sigma_along_m,sigma_across_m,against_chainage,"
      "speed_m_per_s,branch_probability,intervals,next_interval,next_is,next_distance_m,next_in_s,"
      "next_in_sigma_s");
}

void IntervalsCsvWriter::write(const interval::IntervalBelief& belief) {
  std::string row = text::stampSeconds(belief.stamp) + "," + word(belief.state);
  if (belief.state == MatchState::Waiting) {
    lines_.write(row + ",,,,,,,,,,,,,,");
    return;
  }
  row += "," + text::csvCell(roadways_[belief.point.roadway]) + "," + fixed(belief.point.chainage, 3) + "," +
         fixed(belief.point.offset, 3) + "," + fixed(belief.along_sigma, 3) + "," +
         fixed(belief.across_sigma, 3) + "," + (belief.against_chainage ? "1" : "0") + "," +
         fixed(belief.speed, 3) + "," + fixed(belief.branch_probability, 4) + ",";
  std::string list;
  for (const interval::IntervalProbability& p : belief.intervals)
    list += (list.empty() ? "" : " ") + ids_[p.interval] + "=" + fixed(p.probability, 4);
  row += text::csvCell(list) + ",";
  if (!belief.next) {
    row += ",,,,";
  } else {
    row += text::csvCell(ids_[belief.next->interval]) + (belief.next->entry ? ",entry," : ",exit,") +
           fixed(belief.next->distance, 2) + "," + fixed(belief.next->seconds, 2) + "," +
           fixed(belief.next->seconds_sigma, 2);
  }
  lines_.write(row);
}

RunEvent runEvent(const IntervalEvent& event, const std::string& estimator,
                  const std::vector<map::LockInterval>& intervals) {
  RunEvent line{.stamp = event.stamp, .estimator = estimator, .kind = kindOf(event.kind)};
  const bool edge = event.kind == IntervalEvent::Kind::Entry || event.kind == IntervalEvent::Kind::Exit;
  if (edge) {
    const map::LockInterval& interval = intervals[event.interval];
    line.detail = interval.label() + " " + interval.id + " at " + text::stampSeconds(event.at) +
                  " s, sigma " + fixed(event.at_sigma, 2) + " s, ";
  }
  if (event.kind == IntervalEvent::Kind::BranchDecided)
    line.detail += fixed(event.past_node, 1) + " m past the junction, ";
  line.detail += "confidence " + fixed(event.confidence, 4);
  return line;
}

}  // namespace pos::io
