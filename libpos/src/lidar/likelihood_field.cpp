#include "pos/lidar/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "field_kernels.hpp"
#include "pos/core/error.hpp"

namespace pos::lidar {
namespace kernel {

const FieldKernels& fieldKernels(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx2:
      return kAvx2;
    case InstructionSet::Avx512:
      return kAvx512;
    case InstructionSet::Portable:
      break;
  }
  return kPortable;
}

}  // namespace kernel

namespace {

/// Place of a cell in a row-major table.
std::size_t cellIndex(int row, int column, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

constexpr double kSteps = 65535.0;

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
      column_max_(static_cast<std::uint32_t>(cells.columns + 1)),
      row_max_(static_cast<std::uint32_t>(cells.rows + 1)),
      step_(-std::log(model.outlier_probability) / kSteps) {
  ensure(cells.columns > 0 && cells.rows > 0 && cells.resolution > 0.0, "likelihood field of an empty grid");
  ensure(cells.occupancy.size() == cellCount(cells), "likelihood field: cells do not match the size");
  ensure(model.sigma > 0.0 && model.distance_max > 0.0, "likelihood field: sigma and reach must be positive");
  const double p = model.outlier_probability;
  ensure(p > 0.0 && p <= 1.0, "likelihood field: outlier probability must be in (0, 1]");
  const std::vector<float> distances = obstacleDistances(cells, model.distance_max);
  const auto entry = [&](double likelihood) {
    return static_cast<std::uint16_t>(p < 1.0 ? std::lround(-std::log(likelihood) / step_) : 0);
  };
  table_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(cells.rows + 2) + 1, entry(p));
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      const double d = distances[cellIndex(row, column, cells.columns)] / model.sigma;
      table_[cellIndex(row + 1, column + 1, stride_)] = entry((1.0 - p) * std::exp(-0.5 * d * d) + p);
    }
  }
}

float LikelihoodField::at(float x, float y) const {
  const float one = 1.0F;
  const float zero = 0.0F;
  BeamPoints here;
  here.x = {0.0F};
  here.y = {0.0F};
  here.weight = {1.0F};
  float total = 0.0F;
  addScores({{&x, 1}, {&y, 1}, {&one, 1}, {&zero, 1}}, here, {&total, 1});
  return total;
}

void LikelihoodField::addScores(const PosesView& poses, const BeamPoints& beams, std::span<float> totals,
                                InstructionSet with) const {
  // Sixteen beams at a time: those that fill up the last sixteen weigh nothing.
  BeamPoints filled = beams;
  for (auto* array : {&filled.x, &filled.y, &filled.weight}) array->resize((beams.size() + 15) / 16 * 16);
  kernel::fieldKernels(with).addScores({.table = table_.data(),
                                        .stride = stride_,
                                        .column_max = column_max_,
                                        .row_max = row_max_,
                                        .x_origin = x_origin_,
                                        .y_origin = y_origin_,
                                        .cells_per_metre = cells_per_metre_,
                                        .unit = static_cast<float>(-step_)},
                                       {.x = poses.x.data(),
                                        .y = poses.y.data(),
                                        .cosine = poses.cosine.data(),
                                        .sine = poses.sine.data(),
                                        .total = totals.data(),
                                        .poses = totals.size(),
                                        .beam_x = filled.x.data(),
                                        .beam_y = filled.y.data(),
                                        .beam_weight = filled.weight.data(),
                                        .beams = filled.size()});
}

}  // namespace pos::lidar
