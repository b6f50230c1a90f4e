#pragma once
/// Satellite pseudoranges, tightly coupled: an inertial state with the receiver's clock beside it. A model:
/// no reading of the library carries pseudoranges, since the logs it reads hold fixes only.

#include "pos/filters/ekf.hpp"
#include "pos/ins/eskf.hpp"

namespace pos::estimation {

/// Tangent [error of the inertial state, clock offset, clock drift].
struct ClockedState {
  static constexpr int kDof = 17;
  static constexpr int kClock = 15;
  static constexpr int kDrift = 16;

  ins::EskfState inertial;
  double clock = 0.0;  ///< m, c times the receiver's offset
  double drift = 0.0;  ///< m/s
};

ClockedState plus(const ClockedState& x, const Vector<17>& d);
Vector<17> minus(const ClockedState& to, const ClockedState& from);

/// Densities of the clock's noise (two-state model).
struct ClockNoise {
  double offset = 0.3;  ///< m / sqrt(s), S_b^(1/2)
  double drift = 0.1;   ///< m/s / sqrt(s), S_d^(1/2)
};
/// Noise of offset and drift over dt: [S_b dt + S_d dt^3 / 3, S_d dt^2 / 2; ., S_d dt].
Matrix<2, 2> clockNoise(const ClockNoise& noise, double dt);

/// The whole state one inertial sample further, with F and Qd in full matrices.
filters::Step<ClockedState> stepped(const ClockedState& x, const ins::ImuIncrement& raw,
                                    const ins::EskfProcess& process, const ClockNoise& clock);

/// A satellite's place at transmission, seen in axes of the Earth at reception: turned by the Earth's rate
/// over the `travel` (s) of the signal (Sagnac). Earth-centred, m.
Eigen::Vector3d atReception(const Eigen::Vector3d& p_ecef_at_transmission, double travel);

/// h = |p + R l - s| + clock, s = satellite in map axes (atReception, then the map's tie to the Earth), m.
/// Satellite clock, ionosphere and troposphere are taken off before.
filters::Innovation<ClockedState, 1> pseudorange(const ClockedState& x, double range,
                                                 const Eigen::Vector3d& satellite_map,
                                                 const Eigen::Vector3d& lever);

}  // namespace pos::estimation
