#pragma once
/// Figures of many drives of scenario B-E5 with one kind of aiding.

#include <cstdio>

#include "support/interval_drive.hpp"

namespace pos::testing {

struct DriveFigures {
  std::size_t judged = 0;  ///< moments outside 3 sigma of every boundary
  std::size_t wrong_sets = 0;
  double decided_past = 0.0;  ///< m, the worst
  int sightings = 0;
  int wrong_told = 0;
  int wrong_accepted = 0;
  int right_refused = 0;
  int missing_told = 0;
  int missed_noted = 0;
  int trace_grew = 0;
  double along_sigma_over_bound = 0.0;  ///< largest
  double across_sigma_over_bound = 0.0;
  double along_over_bound = 0.0;  ///< rms of error / bound
  double across_over_bound = 0.0;
  double rms_early = 0.0;  ///< m, of the position in the first 100 m
  double rms_late = 0.0;   ///< m, in the last 100 m

  double rightShare() const { return 1.0 - static_cast<double>(wrong_sets) / static_cast<double>(judged); }
};

inline double square(double x) {
  return x * x;
}

inline DriveFigures figuresOf(const IntervalDrive& scene, Aiding aiding, std::uint64_t seeds) {
  DriveFigures f;
  double n = 0.0;
  double early = 0.0;
  double late = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const bool into_branch : {false, true}) {
      const DriveResult r = scene.run({.seed = seed, .into_branch = into_branch, .aiding = aiding});
      f.decided_past = std::max(f.decided_past, r.decided_past);
      f.sightings += r.sightings;
      f.wrong_told += r.wrong_told;
      f.wrong_accepted += r.wrong_accepted;
      f.right_refused += r.right_refused;
      f.missing_told += r.missing_told;
      f.missed_noted += r.missed_noted;
      f.trace_grew += r.trace_grew;
      for (const DriveSample& s : r.samples) {
        f.judged += s.near_boundary ? 0 : 1;
        f.wrong_sets += !s.near_boundary && !s.right_set ? 1 : 0;
        f.along_sigma_over_bound = std::max(f.along_sigma_over_bound, s.along_sigma / s.along_bound);
        f.across_sigma_over_bound = std::max(f.across_sigma_over_bound, s.across_sigma / s.across_bound);
        f.along_over_bound += square(s.along / s.along_bound);
        f.across_over_bound += square(s.across / s.across_bound);
        n += 1.0;
        const double error = square(s.along) + square(s.across);
        if (s.driven < 100.0) f.rms_early += error;
        if (s.driven < 100.0) early += 1.0;
        if (s.driven > r.samples.back().driven - 100.0) f.rms_late += error;
        if (s.driven > r.samples.back().driven - 100.0) late += 1.0;
      }
    }
  }
  f.along_over_bound = std::sqrt(f.along_over_bound / n);
  f.across_over_bound = std::sqrt(f.across_over_bound / n);
  f.rms_early = std::sqrt(f.rms_early / early);
  f.rms_late = std::sqrt(f.rms_late / late);
  return f;
}

inline void printHead() {
  std::printf("%-16s %9s %8s %9s %8s %8s %8s %8s %8s %8s %9s %9s %9s\n", "aiding", "right set", "decided",
              "rms <100m", "rms end", "e_s/bnd", "e_n/bnd", "s_s/bnd", "s_n/bnd", "sighted", "wrong t/a",
              "right ref", "missed t/n");
}
inline void print(const char* name, const DriveFigures& f) {
  std::printf("%-16s %8.3f%% %6.1f m %7.2f m %6.2f m %8.2f %8.2f %8.2f %8.2f %8d %5d/%-3d %9d %5d/%d\n", name,
              100.0 * f.rightShare(), f.decided_past, f.rms_early, f.rms_late, f.along_over_bound,
              f.across_over_bound, f.along_sigma_over_bound, f.across_sigma_over_bound, f.sightings,
              f.wrong_told, f.wrong_accepted, f.right_refused, f.missing_told, f.missed_noted);
}

}  // namespace pos::testing
