#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/text.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {
namespace {

/// Rows of numbers without a header, split at blanks or at commas. Lines that start with '#' do not count.
class NumberRows {
 public:
  enum class Separator { Blank, Comma };
  NumberRows(const std::filesystem::path& path, Separator separator)
      : path_(path), file_(path, std::ios::binary), separator_(separator) {
    if (file_ && !std::filesystem::is_directory(path)) return;
    throw DataError(Complaint{.what = "cannot open the trajectory",
                              .place = {.file = path.string()},
                              .suggestion = "check the folder and the file name"});
  }

  bool next() {
    while (std::getline(file_, text_)) {
      ++line_;
      if (text_.ends_with('\r')) text_.pop_back();
      const std::string_view content = text::trimmed(text_);
      if (content.empty() || content.starts_with('#')) continue;
      words_ = separator_ == Separator::Blank ? text::words(content) : atCommas(content);
      return true;
    }
    return false;
  }

  std::size_t size() const { return words_.size(); }
  double number(std::size_t i) const {
    const auto value = text::number(words_[i]);
    if (!value) refuse("the value is not a finite number", std::string(words_[i]), "a number", i);
    return *value;
  }
  std::int64_t integer(std::size_t i) const {
    const auto value = text::integer(words_[i]);
    if (!value) refuse("the value is not a whole number", std::string(words_[i]), "a whole number", i);
    return *value;
  }
  Stamp stamp(std::size_t i, text::TimeUnit unit) const {
    const auto value = text::duration(words_[i], unit);
    if (!value) refuse("the stamp is not a time", std::string(words_[i]), "a number within +-4.6e9 s", i);
    return Stamp{*value};
  }

  [[noreturn]] void refuse(const std::string& what, const std::string& got, const std::string& expected,
                           std::size_t word = 0) const {
    const auto column = word < words_.size() ? words_[word].data() - text_.data() + 1 : 0;
    throw DataError(
        Complaint{.what = what,
                  .place = {.file = path_.string(), .line = line_, .column = static_cast<int>(column)},
                  .got = got,
                  .expected = expected});
  }
  void requireSize(bool holds, const std::string& expected) const {
    if (!holds) refuse("the row has the wrong length", std::to_string(size()) + " values", expected);
  }
  void requirePoses(const Truth& truth) const {
    if (truth.poses.empty()) refuseFile("the trajectory holds no pose", "no rows", "at least one row");
  }
  [[noreturn]] void refuseFile(const std::string& what, const std::string& got,
                               const std::string& expected) const {
    throw DataError(
        Complaint{.what = what, .place = {.file = path_.string()}, .got = got, .expected = expected});
  }

 private:
  static std::vector<std::string_view> atCommas(std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      cells.push_back(text::trimmed(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    return cells;
  }

  std::filesystem::path path_;
  std::ifstream file_;
  Separator separator_;
  std::string text_;
  std::vector<std::string_view> words_;
  int line_ = 0;
};

/// Position from three values at `first` on, quaternion from four at `quaternion` on.
enum class QuaternionOrder { XyzW, WXyz };
Pose3 poseOf(const NumberRows& rows, std::size_t first, QuaternionOrder order) {
  const Eigen::Vector3d p{rows.number(first), rows.number(first + 1), rows.number(first + 2)};
  const std::size_t w = order == QuaternionOrder::WXyz ? first + 3 : first + 6;
  const std::size_t x = order == QuaternionOrder::WXyz ? first + 4 : first + 3;
  const Eigen::Quaterniond q{rows.number(w), rows.number(x), rows.number(x + 1), rows.number(x + 2)};
  if (!(std::abs(q.norm() - 1.0) <= 0.01)) {
    rows.refuse("the quaternion does not have length 1", "length " + text::shortest(q.norm()), "0.99 .. 1.01",
                first + 3);
  }
  return {p, q.normalized()};
}

void requireLater(const NumberRows& rows, Stamp stamp, const Truth& truth) {
  if (truth.poses.empty() || stamp > truth.poses.back().stamp) return;
  rows.refuse("the truth's stamps do not increase", text::stampSeconds(stamp) + " s",
              "a stamp after " + text::stampSeconds(truth.poses.back().stamp) + " s");
}

/// A symmetric 3x3 block from its upper triangle, row by row.
Matrix<3, 3> symmetric(const NumberRows& rows, std::size_t first) {
  Matrix<3, 3> block;
  std::size_t at = first;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) block(i, j) = block(j, i) = rows.number(at++);
  }
  return block;
}

}  // namespace

namespace {

/// TUM has no way to say "not measured": a file in which every orientation is the identity holds none, and
/// one in which every height is exactly zero is a plan.
Truth withKnownParts(Truth truth) {
  const auto turned = [](const TruthPose& pose) { return !pose.T_map_body.rotation.vec().isZero(0.0); };
  const auto raised = [](const TruthPose& pose) { return pose.T_map_body.translation.z() != 0.0; };
  truth.has_yaw = std::any_of(truth.poses.begin(), truth.poses.end(), turned);
  truth.has_z = std::any_of(truth.poses.begin(), truth.poses.end(), raised);
  return truth;
}

}  // namespace

Truth readTumTruth(const std::filesystem::path& path) {
  NumberRows rows(path, NumberRows::Separator::Blank);
  Truth truth;
  while (rows.next()) {
    rows.requireSize(rows.size() == 8, "8 values: t x y z qx qy qz qw");
    const Stamp stamp = rows.stamp(0, text::TimeUnit::Seconds);
    requireLater(rows, stamp, truth);
    truth.poses.push_back({stamp, poseOf(rows, 1, QuaternionOrder::XyzW)});
  }
  rows.requirePoses(truth);
  return withKnownParts(std::move(truth));
}

Truth readEurocTruth(const std::filesystem::path& path) {
  NumberRows rows(path, NumberRows::Separator::Comma);
  Truth truth;
  while (rows.next()) {
    rows.requireSize(rows.size() >= 8, "at least 8 values: t, x, y, z, qw, qx, qy, qz");
    const Stamp stamp = rows.stamp(0, text::TimeUnit::Nanoseconds);
    requireLater(rows, stamp, truth);
    truth.poses.push_back({stamp, poseOf(rows, 1, QuaternionOrder::WXyz)});
  }
  rows.requirePoses(truth);
  return truth;
}

Truth readIndexTruth(const std::filesystem::path& path, const FrameStamps& frames, const Pose2& T_map_truth) {
  const std::vector<Stamp>& stamps = frames.stamps;
  NumberRows rows(path, NumberRows::Separator::Blank);
  Truth truth;
  truth.has_z = false;
  while (rows.next()) {
    rows.requireSize(rows.size() == 4, "4 values: index x y phi");
    const std::size_t row = truth.poses.size();
    if (row >= stamps.size() && !frames.complete) break;  // the log lost the rest
    if (row >= stamps.size()) {
      rows.refuse("more truth rows than frames in the log", "row " + std::to_string(row),
                  std::to_string(stamps.size()) + " rows");
    }
    if (rows.integer(0) != static_cast<std::int64_t>(row)) {
      rows.refuse("the index does not count up from 0", std::to_string(rows.integer(0)), std::to_string(row));
    }
    requireLater(rows, stamps[row], truth);
    const Pose2 T_truth_body{rows.number(1), rows.number(2), wrapAngle(rows.number(3))};
    truth.poses.push_back({stamps[row], Pose3::fromPlanar(T_map_truth * T_truth_body)});
  }
  if (truth.poses.size() != stamps.size()) {
    rows.refuseFile("fewer truth rows than frames in the log", std::to_string(truth.poses.size()) + " rows",
                    std::to_string(stamps.size()) + " rows");
  }
  return truth;
}

std::vector<Estimate> readTum(const std::filesystem::path& path) {
  NumberRows rows(path, NumberRows::Separator::Blank);
  std::vector<Estimate> estimates;
  std::size_t width = 0;
  while (rows.next()) {
    if (width == 0) rows.requireSize(rows.size() == 8 || rows.size() == 20, "8 or 20 values");
    if (width != 0) rows.requireSize(rows.size() == width, std::to_string(width) + " values as above");
    width = rows.size();
    Estimate estimate{rows.stamp(0, text::TimeUnit::Seconds), poseOf(rows, 1, QuaternionOrder::XyzW)};
    if (!estimates.empty() && estimate.stamp < estimates.back().stamp) {
      rows.refuse("the trajectory's stamps go back", text::stampSeconds(estimate.stamp) + " s",
                  "no earlier than " + text::stampSeconds(estimates.back().stamp) + " s");
    }
    if (width == 20) {
      estimate.covariance.bottomRightCorner<3, 3>() = symmetric(rows, 8);
      estimate.covariance.topLeftCorner<3, 3>() = symmetric(rows, 14);
    }
    estimates.push_back(estimate);
  }
  return estimates;
}

}  // namespace pos::io
