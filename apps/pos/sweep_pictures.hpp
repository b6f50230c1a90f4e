#pragma once
/// Pictures of sweeps for the report: what a shearer made of one of them.

#include <optional>
#include <string>

#include "pos/core/verdict.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/report/leg_picture.hpp"

namespace pos::app {

/// Looks over an estimator's shoulder, and keeps the newest sweep it used among those 1, 2, 4, 8, ... s after
/// the first: one from the second half of the run, however long that is.
class SweepPictures {
 public:
  void look(const estimation::Estimator& estimator, const Measurement& measurement,
            const IngestReport& report);
  /// Nothing where no whole sweep was used.
  const std::optional<report::LegPicture>& picture() const { return picture_; }

 private:
  std::optional<Stamp> first_;
  double next_ = 0.0;  // s after the first
  std::optional<report::LegPicture> picture_;
};

}  // namespace pos::app
