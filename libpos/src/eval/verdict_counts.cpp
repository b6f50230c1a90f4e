#include "pos/eval/verdict_counts.hpp"

#include <cmath>

namespace pos::eval {

namespace {

/// The entry of `key`, made when it is new; a known key costs no string.
template <class Map>
typename Map::mapped_type& entry(Map& map, std::string_view key) {
  const auto found = map.find(key);
  return found != map.end() ? found->second : map[std::string(key)];
}

}  // namespace

void Tally::add(const IngestReport& report) {
  ++counts[static_cast<std::size_t>(report.verdict)];
  if (!report.reason.empty()) ++entry(reasons, report.reason);
  if (report.verdict == Verdict::Applied && report.dof > 0 && std::isfinite(report.nis)) {
    ++nis_count;
    nis_sum += report.nis;
    dof_sum += static_cast<std::uint64_t>(report.dof);
  }
}

void Tally::add(const Tally& other) {
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  for (const auto& [reason, count] : other.reasons) reasons[reason] += count;
  nis_count += other.nis_count;
  nis_sum += other.nis_sum;
  dof_sum += other.dof_sum;
}

std::uint64_t Tally::total() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counts) sum += count;
  return sum;
}

double Tally::gatedFraction() const {
  const std::uint64_t judged = count(Verdict::Applied) + count(Verdict::Gated);
  return judged == 0 ? 0.0 : static_cast<double>(count(Verdict::Gated)) / static_cast<double>(judged);
}

std::optional<double> Tally::nisMean() const {
  if (nis_count == 0) return std::nullopt;
  return nis_sum / static_cast<double>(nis_count);
}

double Tally::nisDof() const {
  return nis_count == 0 ? 0.0 : static_cast<double>(dof_sum) / static_cast<double>(nis_count);
}

void VerdictCounts::add(std::string_view sensor, std::optional<AnchorId> anchor, const IngestReport& report) {
  entry(sensors_, sensor).add(report);
  if (anchor) anchors_[*anchor].add(report);
}

Tally VerdictCounts::total() const {
  Tally sum;
  for (const auto& [sensor, tally] : sensors_) sum.add(tally);
  return sum;
}

}  // namespace pos::eval
