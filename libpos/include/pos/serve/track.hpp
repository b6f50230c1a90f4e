#pragma once
/// The history of one trajectory, and parts of it as bytes for a browser. Layout: docs/formats/serve.md.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/interval/interval_tracker.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::serve {

/// Everything a row tells beside its stamp.
enum class Column {
  X,
  Y,
  Z,
  Yaw,
  SigmaX,
  SigmaY,
  CorrXY,
  SigmaYaw,
  Speed,
  Error,
  ErrorAlong,
  ErrorAcross,
  Nis,
  Gated,
  Roadway,
  Chainage,
  Interval
};
inline constexpr std::size_t kColumns = 17;
/// "x_m", ... in the order of Column.
const std::array<std::string_view, kColumns>& columnNames();
/// The column with this name, or nothing.
std::optional<Column> columnOf(std::string_view name);

/// Unknown values are NaN.
struct TrackRow {
  Stamp stamp = {};
  std::array<float, kColumns> values = unknown();

  float& operator[](Column column) { return values[static_cast<std::size_t>(column)]; }
  float operator[](Column column) const { return values[static_cast<std::size_t>(column)]; }
  static std::array<float, kColumns> unknown() {
    std::array<float, kColumns> all{};
    all.fill(std::numeric_limits<float>::quiet_NaN());
    return all;
  }
};

/// Pose, sigmas and speed of an estimate.
TrackRow rowOf(const Estimate& estimate);
/// Pose of a reference.
TrackRow rowOf(const TruthPose& truth);
/// Adds the errors against the truth at that moment. `direction` is the unit vector of its motion.
void compare(TrackRow& row, const Pose3& T_map_truth, const std::optional<Eigen::Vector2d>& direction);
/// Adds roadway, chainage and the most probable interval.
void place(TrackRow& row, const interval::IntervalBelief& belief);

/// Rows of a window, as asked for.
struct TrackWindow {
  std::optional<Stamp> from = {};
  std::optional<Stamp> to = {};
  std::size_t points = 20000;
  std::vector<Column> columns = {};  ///< empty: all
};

class Track {
 public:
  /// Rows kept at most; the older half goes when they are reached (80 bytes a row).
  static constexpr std::size_t kMostRows = 4'000'000;

  /// Throws ContractError for a stamp before the last one's.
  void append(const TrackRow& row);
  void clear();

  std::size_t rows() const { return stamps_.size(); }
  std::optional<Stamp> first() const;
  std::optional<Stamp> last() const;
  /// The last row at or before the stamp.
  std::optional<TrackRow> at(Stamp stamp) const;

  /// Indices, ascending, of the rows that stand for the window in at most `points` of them (at least 2): all,
  /// or first, last and the extremes of x and y of equal pieces.
  std::vector<std::size_t> chosen(const TrackWindow& window) const;
  std::string packed(const TrackWindow& window) const;

 private:
  struct Bounds {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  Bounds boundsOf(const TrackWindow& window) const;
  void addExtremes(std::size_t begin, std::size_t end, std::vector<std::size_t>& indices) const;

  std::vector<Stamp> stamps_;
  std::array<std::vector<float>, kColumns> columns_;
};

}  // namespace pos::serve
