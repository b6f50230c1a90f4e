#pragma once
/// Formulas on one piece of time or path; x runs from 0 to `length` on it.

#include <vector>

#include "pos/sim/motion_plan.hpp"

namespace pos::sim {

/// A value and its first two derivatives.
struct Jet {
  double value = 0.0;
  double rate = 0.0;
  double bend = 0.0;
};

/// An angle that changes as a Change says.
struct AnglePiece {
  double start = 0.0;   ///< rad
  double length = 0.0;  ///< s or m
  Change change = {};

  /// Linear and without wave (also: not changing at all).
  bool steady() const;
  Jet at(double x) const;
  double end() const { return at(length).value; }
  /// Values of x inside at which the formula's derivatives jump: the Trapezoid's corners.
  std::vector<double> corners() const;
};

/// A speed that goes from one value to another, and the way it covers.
struct SpeedPiece {
  double from = 0.0;    ///< m/s
  double to = 0.0;      ///< m/s
  double length = 0.0;  ///< s
  Blend blend = Blend::Linear;
  double ramp = 0.0;  ///< s

  bool steady() const { return from == to; }
  struct Value {
    double way = 0.0;           ///< m since the piece's start
    double speed = 0.0;         ///< m/s
    double acceleration = 0.0;  ///< m/s^2
  };
  Value at(double x) const;
  double way() const { return 0.5 * (from + to) * length; }
  std::vector<double> corners() const;
};

/// The index of the last of ascending `starts` that is not after q, at least 0.
std::size_t pieceIndex(const std::vector<double>& starts, double q);

/// Ascending, without repetitions closer than 1e-9 and without those not inside (from, to).
std::vector<double> tidied(std::vector<double> values, double from, double to);

}  // namespace pos::sim
