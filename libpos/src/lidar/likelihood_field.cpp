#include "pos/lidar/likelihood_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pos/core/error.hpp"

namespace pos::lidar {
namespace {

/// Place of a cell in a row-major table.
std::size_t cellIndex(int row, int column, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

constexpr std::size_t kChunk = 64;

std::size_t cellCount(const Cells& cells) {
  return static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows);
}

}  // namespace

std::vector<float> obstacleDistances(const Cells& cells, double distance_max) {
  const auto far = static_cast<float>(distance_max);
  cv::Mat free(cells.rows, cells.columns, CV_8U);
  const auto occupied = [&cells](std::uint8_t percent) {
    return percent >= cells.occupied_from && percent <= 100;
  };
  std::transform(cells.occupancy.begin(), cells.occupancy.end(), free.ptr<std::uint8_t>(),
                 [&](std::uint8_t percent) { return static_cast<std::uint8_t>(occupied(percent) ? 0 : 1); });
  std::vector<float> distances(cellCount(cells), far);
  if (std::none_of(cells.occupancy.begin(), cells.occupancy.end(), occupied)) return distances;
  cv::Mat cells_away(cells.rows, cells.columns, CV_32F);
  cv::distanceTransform(free, cells_away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto resolution = static_cast<float>(cells.resolution);
  std::transform(cells_away.ptr<float>(), cells_away.ptr<float>() + distances.size(), distances.begin(),
                 [=](float away) { return std::min(away * resolution, far); });
  return distances;
}

LikelihoodField::LikelihoodField(const Cells& cells, const BeamModel& model)
    : stride_(cells.columns + 2),
      cells_per_metre_(static_cast<float>(1.0 / cells.resolution)),
      x_origin_(static_cast<float>(cells.x_min - cells.resolution)),
      y_origin_(static_cast<float>(cells.y_min - cells.resolution)),
      column_max_(static_cast<float>(cells.columns + 1)),
      row_max_(static_cast<float>(cells.rows + 1)) {
  ensure(cells.columns > 0 && cells.rows > 0 && cells.resolution > 0.0, "likelihood field of an empty grid");
  ensure(cells.occupancy.size() == cellCount(cells), "likelihood field: cells do not match the size");
  ensure(model.sigma > 0.0 && model.distance_max > 0.0, "likelihood field: sigma and reach must be positive");
  const double p = model.outlier_probability;
  ensure(p > 0.0 && p <= 1.0, "likelihood field: outlier probability must be in (0, 1]");
  const std::vector<float> distances = obstacleDistances(cells, model.distance_max);
  table_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(cells.rows + 2),
                static_cast<float>(std::log(p)));
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      const double d = distances[cellIndex(row, column, cells.columns)] / model.sigma;
      table_[cellIndex(row + 1, column + 1, stride_)] =
          static_cast<float>(std::log((1.0 - p) * std::exp(-0.5 * d * d) + p));
    }
  }
}

float LikelihoodField::at(float x, float y) const {
  const float column = std::clamp((x - x_origin_) * cells_per_metre_, 0.0F, column_max_);
  const float row = std::clamp((y - y_origin_) * cells_per_metre_, 0.0F, row_max_);
  return table_[cellIndex(static_cast<int>(row), static_cast<int>(column), stride_)];
}

void LikelihoodField::addScores(const PosesView& poses, const BeamPoints& beams,
                                std::span<float> totals) const {
  std::array<int, kChunk> index;
  const float scale = cells_per_metre_;
  for (std::size_t first = 0; first < beams.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, beams.size() - first);
    const float* bx = beams.x.data() + first;
    const float* by = beams.y.data() + first;
    const float* weight = beams.weight.data() + first;
    for (std::size_t i = 0; i < totals.size(); ++i) {
      const float c = poses.cosine[i] * scale;
      const float s = poses.sine[i] * scale;
      const float column0 = (poses.x[i] - x_origin_) * scale;
      const float row0 = (poses.y[i] - y_origin_) * scale;
      for (std::size_t b = 0; b < count; ++b) {
        const float column = std::min(std::max(column0 + c * bx[b] - s * by[b], 0.0F), column_max_);
        const float row = std::min(std::max(row0 + s * bx[b] + c * by[b], 0.0F), row_max_);
        index[b] = static_cast<int>(row) * stride_ + static_cast<int>(column);
      }
      float sum = 0.0F;
      for (std::size_t b = 0; b < count; ++b) {
        sum += weight[b] * table_[static_cast<std::size_t>(index[b])];
      }
      totals[i] += sum;
    }
  }
}

}  // namespace pos::lidar
