#pragma once
/// Likelihood field of an occupancy grid (Thrun, Burgard, Fox 2005, section 6.4): how well a beam's end point
/// at a place fits the nearest obstacle, worked out once for every cell.

#include <cstdint>
#include <span>
#include <vector>

#include "pos/core/instruction_set.hpp"

namespace pos::lidar {

/// A grid of occupancy: cell (column, row) covers [x_min + column * resolution, + resolution) x [y_min +
/// ...).
struct Cells {
  int columns = 0;
  int rows = 0;
  double resolution = 0.1;                  ///< m
  double x_min = 0.0;                       ///< m, grid frame
  double y_min = 0.0;                       ///< m
  std::span<const std::uint8_t> occupancy;  ///< percent, row-major from y_min up; above 100 = unknown
  /// Occupied from this percentage up to 100.
  std::uint8_t occupied_from = 65;
};

/// Likelihood of a beam that ends at distance d from the nearest obstacle, relative to a perfect hit:
/// (1 - p) exp(-d^2 / (2 sigma^2)) + p.
struct BeamModel {
  double sigma = 0.1;                ///< m
  double outlier_probability = 0.2;  ///< p: how likely an end point away from everything is, beside a hit
  double distance_max = 1.0;         ///< m, distances saturate here
};

/// Where each particle is, in the grid frame; cosine and sine of its heading. All of one length.
struct PosesView {
  std::span<const float> x;  ///< m
  std::span<const float> y;  ///< m
  std::span<const float> cosine;
  std::span<const float> sine;
};

/// End points of beams in the body frame, and the weight of each in the sum. All of one length.
struct BeamPoints {
  std::vector<float> x;  ///< m
  std::vector<float> y;  ///< m
  std::vector<float> weight;

  std::size_t size() const { return x.size(); }
};

/// The logarithms lie in [ln p, 0] and are kept in 16 bits: half the memory of a float, and good to
/// -ln(p) / 131070 (1.2e-5 for p = 0.2).
class LikelihoodField {
 public:
  /// Needs columns, rows, resolution, sigma, distance_max > 0, 0 < p <= 1 and matching cells (ContractError).
  LikelihoodField(const Cells& cells, const BeamModel& model);

  /// ln of the beam likelihood of the cell that holds this point (m, grid frame); ln p outside the grid. <=
  /// 0.
  float at(float x, float y) const;

  /// How far `at` may lie from the exact logarithm of its cell; a sum over beams from the exact sum by this
  /// times the sum of their weights.
  double errorBound() const { return 0.5 * step_; }

  /// Add to each total the weighted sum over beams of `at` the beam's end point seen from that pose.
  /// Cost O(poses * beams), one table look-up each.
  void addScores(const PosesView& poses, const BeamPoints& beams, std::span<float> totals,
                 InstructionSet with = bestInstructionSet()) const;

 private:
  int stride_;  // columns + 2: the table has a frame of "outside" cells
  float cells_per_metre_;
  float x_origin_;  // of the framed table, m
  float y_origin_;
  std::uint32_t column_max_;  // last column and row of the framed table
  std::uint32_t row_max_;
  double step_;                       // of the table
  std::vector<std::uint16_t> table_;  // -ln of the likelihood in steps; one entry at the end is not used
};

/// Distance (m) from each cell's centre to the nearest occupied cell's centre, row-major; distances beyond
/// `distance_max`, and all where nothing is occupied, are `distance_max`. OpenCV's exact distance transform
/// (Felzenszwalb and Huttenlocher 2012).
std::vector<float> obstacleDistances(const Cells& cells, double distance_max);

}  // namespace pos::lidar
