#include "pos/estimation/pseudorange.hpp"

#include "pos/core/square.hpp"
#include "pos/estimation/eskf_models.hpp"

namespace pos::estimation {
namespace {

constexpr double kEarthRate = 7.292115e-5;  // rad/s, WGS84

}  // namespace

ClockedState plus(const ClockedState& x, const Vector<17>& d) {
  return {plus(x.inertial, Vector<15>(d.head<15>())), x.clock + d[ClockedState::kClock],
          x.drift + d[ClockedState::kDrift]};
}

Vector<17> minus(const ClockedState& to, const ClockedState& from) {
  Vector<17> d;
  d << minus(to.inertial, from.inertial), to.clock - from.clock, to.drift - from.drift;
  return d;
}

Matrix<2, 2> clockNoise(const ClockNoise& noise, double dt) {
  const double b = square(noise.offset);
  const double d = square(noise.drift);
  Matrix<2, 2> Q;
  Q << b * dt + d * dt * dt * dt / 3.0, 0.5 * d * dt * dt, 0.5 * d * dt * dt, d * dt;
  return Q;
}

filters::Step<ClockedState> stepped(const ClockedState& x, const ins::ImuIncrement& raw,
                                    const ins::EskfProcess& process, const ClockNoise& clock) {
  const ins::EskfStep inertial = ins::stepped(x.inertial, raw, process.gravity);
  filters::Step<ClockedState> step;
  step.next = {inertial.next, x.clock + raw.dt * x.drift, x.drift};
  step.F.setIdentity();
  step.F.topLeftCorner<15, 15>() = inertial.F.dense();
  step.F(ClockedState::kClock, ClockedState::kDrift) = raw.dt;
  step.Qd.setZero();
  step.Qd.diagonal().head<15>() = ins::processNoise(process, raw.dt);
  step.Qd.bottomRightCorner<2, 2>() = clockNoise(clock, raw.dt);
  return step;
}

Eigen::Vector3d atReception(const Eigen::Vector3d& p, double travel) {
  const double angle = kEarthRate * travel;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p.x() + s * p.y(), c * p.y() - s * p.x(), p.z()};
}

filters::Innovation<ClockedState, 1> pseudorange(const ClockedState& x, double range,
                                                 const Eigen::Vector3d& satellite_map,
                                                 const Eigen::Vector3d& lever) {
  const RangeSeen seen = seenRange(x.inertial, lever, satellite_map, range);
  filters::Innovation<ClockedState, 1> innovation;
  innovation.nu[0] = seen.row.nu - x.clock;
  innovation.H.setZero();
  innovation.H.head<15>() = seen.row.dense();
  innovation.H[ClockedState::kClock] = 1.0;
  return innovation;
}

}  // namespace pos::estimation
