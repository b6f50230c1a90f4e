#include "curve.hpp"

#include <algorithm>

#include "blend.hpp"
#include "quadrature.hpp"

namespace pos::sim {
namespace {

/// sin(u) / u.
double sinc(double u) {
  const double u2 = u * u;
  return u2 < 1e-6 ? 1.0 - u2 / 6.0 * (1.0 - u2 / 20.0) : std::sin(u) / u;
}

/// Panels on which ten nodes are exact to rounding: a quarter of a radian, a quarter of a wave.
int panelCount(const AnglePiece& angle) {
  double panels =
      std::abs(angle.change.by) * peakRate(angle.change.blend, angle.change.ramp / angle.length) / 0.25;
  if (angle.change.wave_amplitude != 0.0) {
    const double rate = std::abs(angle.change.wave_amplitude) * angle.length;
    panels += rate / 0.25 + 4.0 * angle.length / angle.change.wave_period;
  }
  return 1 + static_cast<int>(panels);
}

bool still(const AnglePiece& angle) {
  return angle.change.by == 0.0 && angle.change.wave_amplitude == 0.0;
}

/// Straight: both angles stay. Arc: one turns steadily and the speed stays.
enum class Shape { Straight, FlatArc, SteepArc, General };

Shape shapeOf(const CurvePiece& piece) {
  if (still(piece.heading) && still(piece.pitch)) return Shape::Straight;
  if (!piece.speed.steady()) return Shape::General;
  if (still(piece.pitch) && piece.heading.steady()) return Shape::FlatArc;
  if (still(piece.heading) && piece.pitch.steady()) return Shape::SteepArc;
  return Shape::General;
}

}  // namespace

Eigen::Vector3d direction(double heading, double pitch) {
  const double c = std::cos(pitch);
  return {c * std::cos(heading), c * std::sin(heading), std::sin(pitch)};
}

Curve::Curve(const Eigen::Vector3d& start, std::vector<CurvePiece> pieces) : pieces_(std::move(pieces)) {
  panel_starts_.push_back(0.0);
  panel_points_.push_back(start);
  std::vector<double> breaks;
  for (const CurvePiece& piece : pieces_) {
    starts_.push_back(length_);
    for (const double x : piece.heading.corners()) breaks.push_back(length_ + x);
    for (const double x : piece.pitch.corners()) breaks.push_back(length_ + x);
    addPanels(piece);
    length_ += piece.length;
    breaks.push_back(length_);
  }
  breaks_ = tidied(std::move(breaks), 0.0, length_);
}

void Curve::addPanels(const CurvePiece& piece) {
  std::vector<double> edges;
  if (shapeOf(piece) == Shape::General) {
    const int count = panelCount(piece.heading) + panelCount(piece.pitch) + (piece.speed.steady() ? 0 : 3);
    for (int i = 1; i < count; ++i) edges.push_back(piece.length * i / count);
    for (const AnglePiece* angle : {&piece.heading, &piece.pitch}) {
      for (const double x : angle->corners()) edges.push_back(x);
    }
    for (const double x : piece.speed.corners()) edges.push_back(x);
  }
  edges = tidied(std::move(edges), 0.0, piece.length);
  edges.push_back(piece.length);
  double x = 0.0;
  for (const double edge : edges) {
    panel_points_.push_back(panel_points_.back() + step(piece, x, edge));
    panel_starts_.push_back(length_ + edge);
    x = edge;
  }
}

Eigen::Vector3d Curve::step(const CurvePiece& piece, double x0, double x1) {
  const auto turned = [&](const AnglePiece& angle) { return angle.at(x1).value - angle.at(x0).value; };
  const auto middle = [&](const AnglePiece& angle) {
    return 0.5 * (angle.at(x1).value + angle.at(x0).value);
  };
  switch (shapeOf(piece)) {
    case Shape::Straight:
      return (piece.speed.at(x1).way - piece.speed.at(x0).way) *
             direction(piece.heading.start, piece.pitch.start);
    case Shape::FlatArc: {
      // The chord of the arc seen from above; the climb is not shortened.
      const double way = piece.speed.from * (x1 - x0);
      Eigen::Vector3d chord = way * direction(middle(piece.heading), piece.pitch.start);
      chord.head<2>() *= sinc(0.5 * turned(piece.heading));
      return chord;
    }
    case Shape::SteepArc:
      return piece.speed.from * (x1 - x0) * sinc(0.5 * turned(piece.pitch)) *
             direction(piece.heading.start, middle(piece.pitch));
    case Shape::General:
      break;
  }
  return integral10(
      [&piece](double x) -> Eigen::Vector3d {
        return piece.speed.at(x).speed * direction(piece.heading.at(x).value, piece.pitch.at(x).value);
      },
      x0, x1);
}

Eigen::Vector3d Curve::positionAt(double q) const {
  const std::size_t i = std::min(pieceIndex(starts_, q), pieces_.size() - 1);
  // The panel that holds q, or the last of this piece for q beyond the end.
  const std::size_t j = std::min(pieceIndex(panel_starts_, q), panel_starts_.size() - 2);
  return panel_points_[j] + step(pieces_[i], panel_starts_[j] - starts_[i], q - starts_[i]);
}

CurvePoint Curve::at(double q) const {
  const std::size_t i = std::min(pieceIndex(starts_, q), pieces_.size() - 1);
  const CurvePiece& piece = pieces_[i];
  const double x = q - starts_[i];
  const SpeedPiece::Value speed = piece.speed.at(x);
  return {positionAt(q), speed.speed, speed.acceleration, piece.heading.at(x), piece.pitch.at(x)};
}

Kinematics attitudeOf(const Jet& heading, const Jet& pitch) {
  const double ch = std::cos(heading.value);
  const double sh = std::sin(heading.value);
  const double cp = std::cos(pitch.value);
  const double sp = std::sin(pitch.value);
  Kinematics body;
  // R_z(heading) R_y(-pitch): FLU counts pitch nose-down.
  body.R_map_body << cp * ch, -sh, -sp * ch, cp * sh, ch, -sp * sh, sp, 0.0, cp;
  body.omega_body = {sp * heading.rate, -pitch.rate, cp * heading.rate};
  body.alpha_body = {cp * pitch.rate * heading.rate + sp * heading.bend, -pitch.bend,
                     -sp * pitch.rate * heading.rate + cp * heading.bend};
  return body;
}

Kinematics kinematicsOf(const Travel& travel) {
  Kinematics body = attitudeOf(travel.heading, travel.pitch);
  body.p_map = travel.p_map;
  body.v_map = travel.speed * body.R_map_body.col(0);
  // d/dt of the x axis is R (omega x e_x) = R [0, omega_z, -omega_y].
  body.a_map = body.R_map_body * Eigen::Vector3d(travel.acceleration, travel.speed * body.omega_body.z(),
                                                 -travel.speed * body.omega_body.y());
  return body;
}

}  // namespace pos::sim
