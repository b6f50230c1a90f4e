#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {
namespace {

constexpr int kMetreDecimals = 9;
constexpr int kQuaternionDecimals = 12;
constexpr int kDegreeDecimals = 10;

constexpr const char* kTumHeader = "# t x y z qx qy qz qw";
constexpr const char* kTumCovarianceHeader =
    "# t x y z qx qy qz qw Rxx Rxy Rxz Ryy Ryz Rzz Pxx Pxy Pxz Pyy Pyz Pzz";
constexpr const char* kEstimateHeader =
    "stamp_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg,"
    "sigma_x_m,sigma_y_m,sigma_z_m,sigma_yaw_deg,sigma_pitch_deg,sigma_roll_deg,"
    "corr_x_y,corr_x_yaw,corr_y_yaw,"
    "applied,gated,too_old,unsupported,degenerate,not_initialised,"
    "v_forward_m_per_s,v_left_m_per_s,yaw_rate_deg_per_s,"
    "sigma_v_forward_m_per_s,sigma_v_left_m_per_s,sigma_yaw_rate_deg_per_s";

void requireFinite(const Estimate& estimate) {
  const Pose3& T = estimate.T_map_body;
  ensure(T.translation.allFinite() && T.rotation.coeffs().allFinite() && estimate.covariance.allFinite(),
         "an estimate that is not finite reached a trajectory file");
  ensure(!estimate.twist || (estimate.twist->rates.allFinite() && estimate.twist->covariance.allFinite()),
         "a velocity that is not finite reached a trajectory file");
}

std::string tumRow(Stamp stamp, const Pose3& T_map_body) {
  // q and -q are one rotation: write the one with qw >= 0
  const Eigen::Quaterniond q = T_map_body.rotation.normalized();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  std::string row = text::stampSeconds(stamp);
  for (const double p : T_map_body.translation) row += ' ' + text::fixed(p, kMetreDecimals);
  for (const double c : q.coeffs()) row += ' ' + text::fixed(sign * c, kQuaternionDecimals);
  return row;
}

std::string upperTriangle(const Matrix<3, 3>& block) {
  std::string row;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) row += ' ' + text::shortest(block(i, j));
  }
  return row;
}

/// Rotation as yaw, pitch, roll (z-y-x, rad). Looking straight up or down, roll is taken as zero.
Eigen::Vector3d yawPitchRoll(const Eigen::Quaterniond& rotation) {
  const Matrix<3, 3> R = rotation.normalized().toRotationMatrix();
  const double level = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), level);
  if (level < 1e-9) return {std::atan2(-R(0, 1), R(1, 1)), pitch, 0.0};
  return {std::atan2(R(1, 0), R(0, 0)), pitch, std::atan2(R(2, 1), R(2, 2))};
}

double correlation(const Matrix<6, 6>& P, int i, int j) {
  const double product = P(i, i) * P(j, j);
  return product > 0.0 ? std::clamp(P(i, j) / std::sqrt(product), -1.0, 1.0) : 0.0;
}

std::string poseCells(const Pose3& T_map_body) {
  std::string row;
  for (const double p : T_map_body.translation) row += ',' + text::fixed(p, kMetreDecimals);
  for (const double angle : yawPitchRoll(T_map_body.rotation)) {
    row += ',' + text::fixed(degrees(angle), kDegreeDecimals);
  }
  return row;
}

std::string covarianceCells(const Matrix<6, 6>& P) {
  const auto sigma = [&P](int i) { return std::sqrt(std::max(P(i, i), 0.0)); };
  std::string row;
  for (const int i : {0, 1, 2}) row += ',' + text::shortest(sigma(i));
  for (const int i : {5, 4, 3}) row += ',' + text::shortest(degrees(sigma(i)));
  row += ',' + text::shortest(correlation(P, 0, 1));
  row += ',' + text::shortest(correlation(P, 0, 5));
  row += ',' + text::shortest(correlation(P, 1, 5));
  return row;
}

/// Empty cells where the estimator does not know how fast it moves.
std::string twistCells(const std::optional<PlanarTwist>& twist) {
  if (!twist) return ",,,,,,";
  const auto sigma = [&](int i) { return std::sqrt(std::max(twist->covariance(i, i), 0.0)); };
  std::string row;
  for (const double value : {twist->rates[0], twist->rates[1], degrees(twist->rates[2])})
    row += ',' + text::shortest(value);
  for (const double value : {sigma(0), sigma(1), degrees(sigma(2))}) row += ',' + text::shortest(value);
  return row;
}

}  // namespace

LineWriter::LineWriter(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  check();
}

void LineWriter::write(const std::string& line) {
  file_ << line << '\n';
  check();
}

void LineWriter::flush() {
  file_.flush();
  check();
}

void LineWriter::close() {
  file_.close();
  check();
}

void LineWriter::check() const {
  if (file_) return;
  throw DataError(Complaint{.what = "cannot write the file",
                            .place = {.file = path_.string()},
                            .suggestion = "check that the folder exists, may be written and has room"});
}

TumWriter::TumWriter(const std::filesystem::path& path) : lines_(path) {
  lines_.write(kTumHeader);
}

void TumWriter::write(const Estimate& estimate) {
  requireFinite(estimate);
  lines_.write(tumRow(estimate.stamp, estimate.T_map_body));
}

TumCovarianceWriter::TumCovarianceWriter(const std::filesystem::path& path) : lines_(path) {
  lines_.write(kTumCovarianceHeader);
}

void TumCovarianceWriter::write(const Estimate& estimate) {
  requireFinite(estimate);
  lines_.write(tumRow(estimate.stamp, estimate.T_map_body) +
               upperTriangle(estimate.covariance.bottomRightCorner<3, 3>()) +
               upperTriangle(estimate.covariance.topLeftCorner<3, 3>()));
}

EstimateCsvWriter::EstimateCsvWriter(const std::filesystem::path& path) : lines_(path) {
  lines_.write(kEstimateHeader);
}

void EstimateCsvWriter::write(const Estimate& estimate, const EpochVerdicts& verdicts) {
  requireFinite(estimate);
  std::string row = text::stampSeconds(estimate.stamp) + poseCells(estimate.T_map_body) +
                    covarianceCells(estimate.covariance);
  for (const std::uint64_t count : verdicts) row += ',' + std::to_string(count);
  lines_.write(row + twistCells(estimate.twist));
}

void writeTum(const std::filesystem::path& path, const Truth& truth) {
  TumWriter writer(path);
  for (const TruthPose& pose : truth.poses) writer.write(Estimate{pose.stamp, pose.T_map_body});
  writer.close();
}

}  // namespace pos::io
