#pragma once
/// Counts what became of every measurement, per sensor and per anchor.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "pos/core/measurement.hpp"
#include "pos/core/verdict.hpp"

namespace pos::eval {

/// Counts of one sensor, one anchor or all together.
struct Tally {
  std::array<std::uint64_t, kVerdicts.size()> counts{};  ///< in the order of kVerdicts
  std::map<std::string, std::uint64_t, std::less<>> reasons;
  /// Over applied readings that had an innovation.
  std::uint64_t nis_count = 0;
  double nis_sum = 0.0;
  std::uint64_t dof_sum = 0;

  void add(const IngestReport& report);
  void add(const Tally& other);
  std::uint64_t count(Verdict verdict) const { return counts[static_cast<std::size_t>(verdict)]; }
  std::uint64_t total() const;
  /// gated / (applied + gated); 0 where neither happened.
  double gatedFraction() const;
  /// Mean NIS of the applied readings; an honest filter gives nisDof(). Nothing where none had an innovation.
  std::optional<double> nisMean() const;
  /// Mean degrees of freedom of the same readings.
  double nisDof() const;
};

class VerdictCounts {
 public:
  void add(std::string_view sensor, std::optional<AnchorId> anchor, const IngestReport& report);

  const std::map<std::string, Tally, std::less<>>& sensors() const { return sensors_; }
  const std::map<AnchorId, Tally>& anchors() const { return anchors_; }
  Tally total() const;

 private:
  std::map<std::string, Tally, std::less<>> sensors_;
  std::map<AnchorId, Tally> anchors_;
};

}  // namespace pos::eval
