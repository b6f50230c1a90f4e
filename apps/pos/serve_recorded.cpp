#include "serve_recorded.hpp"

#include "pos/core/evenly_spread.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

std::vector<Estimate> estimatesIn(const fs::path& file, std::size_t most) {
  io::EstimateCsvReader rows(file);
  EvenlySpread<Estimate> estimates(most);
  while (const auto row = rows.next()) estimates.add(*row);
  return estimates.take();
}

std::vector<Totals> totalsIn(const fs::path& file, std::size_t most) {
  io::CsvReader table(file);
  std::array<std::size_t, kVerdicts.size()> columns{};
  for (const Verdict verdict : kVerdicts)
    columns[static_cast<std::size_t>(verdict)] = table.column(name(verdict));
  EvenlySpread<Totals> totals(most);
  Totals sum{};
  while (table.next()) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      sum[i] += static_cast<std::uint64_t>(table.integer(columns[i]));
    totals.add(sum);
  }
  return totals.take();
}

interval::MatchState stateOf(std::string_view word) {
  using interval::MatchState;
  if (word == "decided") return MatchState::Decided;
  if (word == "branching") return MatchState::Branching;
  return word == "lost" ? MatchState::Lost : MatchState::Waiting;
}

/// Rows of <estimator>.intervals.csv as beliefs again.
class PlaceReader {
 public:
  PlaceReader(const fs::path& file, const serve::Names& names) : table_(file), names_(names) {}

  std::vector<interval::IntervalBelief> read(std::size_t most) {
    EvenlySpread<interval::IntervalBelief> places(most);
    while (table_.next()) places.add(row());
    return places.take();
  }

 private:
  std::string_view cell(const char* column) const { return table_.cell(table_.column(column)); }
  double number(const char* column) const { return table_.number(table_.column(column)); }

  std::optional<std::size_t> intervalOf(std::string_view id) const {
    const auto found = std::find_if(names_.intervals.begin(), names_.intervals.end(),
                                    [&](const map::LockInterval& interval) { return interval.id == id; });
    if (found == names_.intervals.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names_.intervals.begin());
  }

  std::optional<map::RoadwayIndex> roadwayOf(std::string_view id) const {
    const auto found = std::find(names_.roadways.begin(), names_.roadways.end(), id);
    if (found == names_.roadways.end()) return std::nullopt;
    return static_cast<map::RoadwayIndex>(found - names_.roadways.begin());
  }

  interval::IntervalBelief row() const {
    interval::IntervalBelief belief{
        .stamp = Stamp{table_.duration(table_.column("stamp_s"), io::text::TimeUnit::Seconds)},
        .state = stateOf(cell("state"))};
    const auto roadway = roadwayOf(cell("roadway"));
    if (!roadway) {  // waiting, or another map than the run had
      belief.state = interval::MatchState::Waiting;
      return belief;
    }
    belief.point = {*roadway, number("chainage_m"), number("offset_m"), 0.0};
    belief.along_sigma = number("sigma_along_m");
    belief.across_sigma = number("sigma_across_m");
    belief.against_chainage = cell("against_chainage") == "1";
    belief.speed = number("speed_m_per_s");
    belief.branch_probability = number("branch_probability");
    for (const std::string_view word : io::text::words(cell("intervals"))) {
      const std::size_t equals = word.rfind('=');
      const auto interval =
          equals != std::string_view::npos ? intervalOf(word.substr(0, equals)) : std::nullopt;
      if (interval)
        belief.intervals.push_back({*interval, io::text::number(word.substr(equals + 1)).value_or(0.0)});
    }
    if (const auto next = intervalOf(cell("next_interval"))) {
      belief.next = interval::BoundaryAhead{*next, cell("next_is") == "entry", number("next_distance_m"),
                                            number("next_in_s"), number("next_in_sigma_s")};
    }
    return belief;
  }

  io::CsvReader table_;
  const serve::Names& names_;
};

}  // namespace

Recorded recordedIn(const fs::path& folder, const std::string& estimator, const serve::Names& names,
                    std::size_t most) {
  Recorded recorded;
  const fs::path csv = folder / (estimator + ".csv");
  recorded.estimates = estimatesIn(csv, most);
  recorded.totals = totalsIn(csv, most);
  const fs::path intervals = folder / (estimator + ".intervals.csv");
  if (fs::exists(intervals)) recorded.places = PlaceReader(intervals, names).read(most);
  return recorded;
}

}  // namespace pos::app
