#pragma once
/// A curve in space from its heading, pitch and speed over a parameter q (time, or length at speed 1).

#include <vector>

#include "pieces.hpp"

namespace pos::sim {

/// One stretch of the parameter on which heading, pitch and speed each follow one formula.
struct CurvePiece {
  double length = 0.0;  ///< of q
  SpeedPiece speed = {};
  AnglePiece heading = {};
  AnglePiece pitch = {};
};

struct CurvePoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double speed = 0.0;         ///< |dp/dq|, signed
  double acceleration = 0.0;  ///< d speed / dq
  Jet heading = {};
  Jet pitch = {};
};

/// Unit vector of a heading and a nose-up pitch.
Eigen::Vector3d direction(double heading, double pitch);

/// The integral of speed * direction: in closed form on straights and on plain arcs, else by ten-point
/// Gauss-Legendre from the start of a panel on which nothing turns by more than a quarter of a radian.
class Curve {
 public:
  Curve(const Eigen::Vector3d& start, std::vector<CurvePiece> pieces);

  /// Beyond both ends the first and the last formula go on.
  CurvePoint at(double q) const;
  Eigen::Vector3d positionAt(double q) const;
  double length() const { return length_; }
  /// Piece ends and corners of the formulas within (0, length).
  const std::vector<double>& breaks() const { return breaks_; }

 private:
  void addPanels(const CurvePiece& piece);
  /// Way from x0 to x1 of a piece, both within one panel.
  static Eigen::Vector3d step(const CurvePiece& piece, double x0, double x1);

  std::vector<CurvePiece> pieces_;
  std::vector<double> starts_;
  std::vector<double> panel_starts_;
  std::vector<Eigen::Vector3d> panel_points_;
  std::vector<double> breaks_;
  double length_ = 0.0;
};

/// Kinematics from a position, a speed along the body's x axis, and the two angles over time.
struct Travel {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double speed = 0.0;
  double acceleration = 0.0;
  Jet heading = {};
  Jet pitch = {};
};
Kinematics kinematicsOf(const Travel& travel);
/// Attitude, rate and angular acceleration of a body without roll, the other fields zero.
Kinematics attitudeOf(const Jet& heading, const Jet& pitch);

}  // namespace pos::sim
