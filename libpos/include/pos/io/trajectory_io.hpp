#pragma once
/// Trajectories as text files: TUM, TUM with covariance (20 columns), EuRoC ground truth, MRPT's indexed
/// truth, and our own table of estimates. Columns, orders and units: docs/formats/trajectories.md.
///
/// Readers throw DataError with file:line for a row with the wrong number of values, a value that is no
/// finite number, a quaternion whose length is not 1, or a stamp that goes back (truth: that does not
/// increase). Writers give the same bytes for the same input everywhere; they throw DataError when the disk
/// takes no more.

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/core/verdict.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/frame_stamps.hpp"

namespace pos::io {

/// `t x y z qx qy qz qw`, t in seconds. A file whose every orientation is the identity gives a truth without
/// heading, one whose every height is exactly zero a truth without height.
Truth readTumTruth(const std::filesystem::path& path);
/// `t, x, y, z, qw, qx, qy, qz, ...`, t in nanoseconds; further columns are not used.
Truth readEurocTruth(const std::filesystem::path& path);
/// MRPT's `index x y phi` rows (m, rad): row i is the pose at frames.stamps[i]. There must be one row for
/// each stamp; rows for pairs that a damaged log lost are left out. `T_map_truth` moves the poses into the
/// map. The result has no z.
Truth readIndexTruth(const std::filesystem::path& path, const FrameStamps& frames,
                     const Pose2& T_map_truth = {});

/// Trajectory in 8 columns (covariance zero) or 20.
std::vector<Estimate> readTum(const std::filesystem::path& path);
/// What EstimateCsvWriter wrote, row by row: the pose, the planar covariance, the variances of z, roll and
/// pitch, and the velocities with their sigmas.
class EstimateCsvReader {
 public:
  explicit EstimateCsvReader(const std::filesystem::path& path);
  /// Nothing at the end.
  std::optional<Estimate> next();

 private:
  std::optional<PlanarTwist> twist() const;

  struct Columns {
    std::size_t stamp;
    std::array<std::size_t, 3> position;
    std::array<std::size_t, 3> attitude;
    std::array<std::size_t, 6> sigmas;  // in the tangent's order
    std::array<std::size_t, 3> correlations;
    std::array<std::size_t, 3> rates;
    std::array<std::size_t, 3> rate_sigmas;
  };
  CsvReader csv_;
  Columns columns_;
  std::optional<Stamp> last_;
};
/// All of them.
std::vector<Estimate> readEstimateCsv(const std::filesystem::path& path);

/// A text file under construction, one line at a time. Its destructor closes it; call close() to learn
/// whether everything reached the disk.
class LineWriter {
 public:
  explicit LineWriter(const std::filesystem::path& path);
  void write(const std::string& line);
  /// What is written so far reaches the file even when the program is killed.
  void flush();
  void close();

 private:
  void check() const;
  std::filesystem::path path_;
  std::ofstream file_;
};

class TumWriter {
 public:
  explicit TumWriter(const std::filesystem::path& path);
  void write(const Estimate& estimate);
  void flush() { lines_.flush(); }
  void close() { lines_.close(); }

 private:
  LineWriter lines_;
};

/// 8 columns of TUM, then the upper triangle of the orientation's covariance (rad^2, body axes), then that of
/// the position's (m^2, map axes). What couples position and orientation does not fit in.
class TumCovarianceWriter {
 public:
  explicit TumCovarianceWriter(const std::filesystem::path& path);
  void write(const Estimate& estimate);
  void flush() { lines_.flush(); }
  void close() { lines_.close(); }

 private:
  LineWriter lines_;
};

/// How many measurements of one epoch got each verdict, in the order of kVerdicts.
using EpochVerdicts = std::array<std::uint64_t, kVerdicts.size()>;

class EstimateCsvWriter {
 public:
  explicit EstimateCsvWriter(const std::filesystem::path& path);
  void write(const Estimate& estimate, const EpochVerdicts& verdicts);
  void flush() { lines_.flush(); }
  void close() { lines_.close(); }

 private:
  LineWriter lines_;
};

/// All poses at once, as TumWriter writes them.
void writeTum(const std::filesystem::path& path, const Truth& truth);

}  // namespace pos::io
