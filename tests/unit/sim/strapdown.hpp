#pragma once
/// An integrator of inertial increments for the tests, written on its own: increments become polynomials of
/// rate and specific force over runs without breaks, then Runge-Kutta of fourth order.

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "pos/sim/motion.hpp"

namespace pos::sim::oracle {

struct Sample {
  double from = 0.0;
  double to = 0.0;
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();     ///< rad
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

struct State {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

struct World {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< rad/s
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> gravity;
};

/// Mean rates over up to five neighbouring intervals, turned into the rate at any time of interval `i`: the
/// derivative of the polynomial through the sums of increments (Lagrange).
class RateFit {
 public:
  RateFit(const std::vector<Sample>& samples, std::size_t first, std::size_t last)
      : samples_(samples), first_(first), n_(last - first + 1) {}

  /// rad/s and m/s^2 at `t`.
  Eigen::Matrix<double, 6, 1> at(double t) const {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    Eigen::Matrix<double, 6, 1> rate = sum;
    for (std::size_t k = 1; k <= n_; ++k) {
      const Sample& sample = samples_[first_ + k - 1];
      sum.head<3>() += sample.angle;
      sum.tail<3>() += sample.velocity;
      rate += slope(k, t) * sum;
    }
    return rate;
  }

 private:
  double node(std::size_t k) const { return k == 0 ? samples_[first_].from : samples_[first_ + k - 1].to; }
  /// Derivative of the k-th Lagrange polynomial.
  double slope(std::size_t k, double t) const {
    double sum = 0.0;
    for (std::size_t j = 0; j <= n_; ++j) {
      if (j == k) continue;
      double product = 1.0 / (node(k) - node(j));
      for (std::size_t m = 0; m <= n_; ++m) {
        if (m != k && m != j) product *= (t - node(m)) / (node(k) - node(m));
      }
      sum += product;
    }
    return sum;
  }

  const std::vector<Sample>& samples_;
  std::size_t first_;
  std::size_t n_;
};

inline State slopeOf(const State& x, const Eigen::Matrix<double, 6, 1>& u, const World& world) {
  const Eigen::Matrix3d R = x.q.normalized().toRotationMatrix();
  const Eigen::Vector3d omega = u.head<3>() - R.transpose() * world.rotation;
  State d;
  d.p = x.v;
  d.v = R * u.tail<3>() - 2.0 * world.rotation.cross(x.v) + world.gravity(x.p);
  d.q.coeffs() = 0.5 * (x.q * Eigen::Quaterniond(0.0, omega.x(), omega.y(), omega.z())).coeffs();
  return d;
}

inline State moved(const State& x, const State& d, double dt) {
  State y{x.p + dt * d.p, x.v + dt * d.v, x.q};
  y.q.coeffs() += dt * d.q.coeffs();
  return y;
}

inline State stepped(const State& x, const RateFit& fit, double from, double to, const World& world) {
  const double dt = to - from;
  const auto middle = fit.at(0.5 * (from + to));
  const State k1 = slopeOf(x, fit.at(from), world);
  const State k2 = slopeOf(moved(x, k1, 0.5 * dt), middle, world);
  const State k3 = slopeOf(moved(x, k2, 0.5 * dt), middle, world);
  const State k4 = slopeOf(moved(x, k3, dt), fit.at(to), world);
  State y{x.p + dt / 6.0 * (k1.p + 2 * k2.p + 2 * k3.p + k4.p),
          x.v + dt / 6.0 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v), x.q};
  y.q.coeffs() += dt / 6.0 * (k1.q.coeffs() + 2 * k2.q.coeffs() + 2 * k3.q.coeffs() + k4.q.coeffs());
  y.q.normalize();
  return y;
}

/// Whether a polynomial may not go over the border between sample i - 1 and sample i, or i holds a break.
inline bool brokenBetween(const std::vector<Sample>& s, std::size_t a, std::size_t b,
                          const std::vector<double>& breaks) {
  for (const double t : breaks) {
    if (t > s[a].from + 1e-9 && t < s[b].to - 1e-9) return true;
  }
  return false;
}

/// The state after each sample. Breaks are those of the truth: a real unit's rates have none.
inline std::vector<State> integrated(const std::vector<Sample>& samples, State x, const World& world,
                                     const std::vector<double>& breaks) {
  std::vector<State> states;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> near;
    for (const double t : breaks) {
      if (t > samples[i].from - 1.0 && t < samples[i].to + 1.0) near.push_back(t);
    }
    std::size_t first = i;
    std::size_t last = i;
    for (int grown = 0; grown < 4; ++grown) {
      const bool back = first > 0 && i - first <= last - i && !brokenBetween(samples, first - 1, last, near);
      const bool ahead = !back && last + 1 < samples.size() && !brokenBetween(samples, first, last + 1, near);
      const bool back_after_all =
          !back && !ahead && first > 0 && !brokenBetween(samples, first - 1, last, near);
      if (back || back_after_all) --first;
      if (ahead) ++last;
    }
    const RateFit fit(samples, first, last);
    x = stepped(x, fit, samples[i].from, samples[i].to, world);
    states.push_back(x);
  }
  return states;
}

}  // namespace pos::sim::oracle
