#include <array>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/core/square.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {
namespace {

constexpr std::array<std::array<int, 2>, 3> kCorrelated{{{0, 1}, {0, 5}, {1, 5}}};

double sigmaOf(const CsvReader& csv, std::size_t column, double unit) {
  const double sigma = csv.number(column) * unit;
  if (sigma < 0.0) csv.refuse(column, "a standard deviation is negative", ">= 0");
  return sigma;
}

}  // namespace

EstimateCsvReader::EstimateCsvReader(const std::filesystem::path& path) : csv_(path) {
  const auto at = [this](const char* name) { return csv_.column(name); };
  columns_ = {.stamp = at("stamp_s"),
              .position = {at("x_m"), at("y_m"), at("z_m")},
              .attitude = {at("yaw_deg"), at("pitch_deg"), at("roll_deg")},
              .sigmas = {at("sigma_x_m"), at("sigma_y_m"), at("sigma_z_m"), at("sigma_roll_deg"),
                         at("sigma_pitch_deg"), at("sigma_yaw_deg")},
              .correlations = {at("corr_x_y"), at("corr_x_yaw"), at("corr_y_yaw")},
              .rates = {at("v_forward_m_per_s"), at("v_left_m_per_s"), at("yaw_rate_deg_per_s")},
              .rate_sigmas = {at("sigma_v_forward_m_per_s"), at("sigma_v_left_m_per_s"),
                              at("sigma_yaw_rate_deg_per_s")}};
}

std::optional<Estimate> EstimateCsvReader::next() {
  if (!csv_.next()) return std::nullopt;
  Estimate estimate;
  estimate.stamp = Stamp{csv_.duration(columns_.stamp, text::TimeUnit::Seconds)};
  if (last_ && estimate.stamp < *last_) {
    throw DataError(Complaint{.what = "the trajectory's stamps go back",
                              .place = csv_.place(columns_.stamp),
                              .got = text::stampSeconds(estimate.stamp) + " s",
                              .expected = "no earlier than " + text::stampSeconds(*last_) + " s"});
  }
  last_ = estimate.stamp;
  const auto metres = [&](std::size_t i) { return csv_.number(columns_.position[i]); };
  const auto angle = [&](std::size_t i) { return radians(csv_.number(columns_.attitude[i])); };
  estimate.T_map_body =
      Pose3::fromXyzYawPitchRoll(metres(0), metres(1), metres(2), angle(0), angle(1), angle(2));
  Matrix<6, 6>& P = estimate.covariance;
  for (int i = 0; i < 6; ++i) {
    const std::size_t column = columns_.sigmas[static_cast<std::size_t>(i)];
    P(i, i) = square(sigmaOf(csv_, column, i < 3 ? 1.0 : radians(1.0)));
  }
  for (std::size_t k = 0; k < kCorrelated.size(); ++k) {
    const auto [i, j] = kCorrelated[k];
    const double correlation = csv_.number(columns_.correlations[k]);
    if (std::abs(correlation) > 1.0)
      csv_.refuse(columns_.correlations[k], "a correlation is out of range", "-1 .. 1");
    P(i, j) = P(j, i) = correlation * std::sqrt(P(i, i) * P(j, j));
  }
  estimate.twist = twist();
  return estimate;
}

std::optional<PlanarTwist> EstimateCsvReader::twist() const {
  if (csv_.cell(columns_.rates[0]).empty()) return std::nullopt;
  PlanarTwist twist;
  for (std::size_t i = 0; i < 3; ++i) {
    const double unit = i < 2 ? 1.0 : radians(1.0);
    const auto row = static_cast<Eigen::Index>(i);
    twist.rates[row] = csv_.number(columns_.rates[i]) * unit;
    twist.covariance(row, row) = square(sigmaOf(csv_, columns_.rate_sigmas[i], unit));
  }
  return twist;
}

std::vector<Estimate> readEstimateCsv(const std::filesystem::path& path) {
  EstimateCsvReader reader(path);
  std::vector<Estimate> estimates;
  while (auto estimate = reader.next()) estimates.push_back(std::move(*estimate));
  return estimates;
}

}  // namespace pos::io
