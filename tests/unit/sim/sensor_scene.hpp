#pragma once
/// Simple motions and counting for the tests of simulated sensors.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/sensor.hpp"

namespace pos::sim::scene {

/// A motion without events.
class PlainMotion : public Motion {
 public:
  explicit PlainMotion(double duration) : duration_(duration) {}
  double duration() const override { return duration_; }
  const std::vector<double>& breaks() const override { return breaks_; }

 private:
  double duration_;
  std::vector<double> breaks_ = {};
};

/// Straight at constant speed, facing along x.
class Line : public PlainMotion {
 public:
  Line(Eigen::Vector3d start, Eigen::Vector3d velocity, double duration)
      : PlainMotion(duration), start_(start), velocity_(velocity) {}
  Kinematics at(double t) const override {
    Kinematics k;
    if (t >= 0.0 && t <= duration()) k.v_map = velocity_;
    k.p_map = start_ + velocity_ * std::clamp(t, 0.0, duration());
    return k;
  }
  double travelled(double t) const override { return velocity_.norm() * t; }

 private:
  Eigen::Vector3d start_;
  Eigen::Vector3d velocity_;
};

inline std::shared_ptr<const Motion> standing(Eigen::Vector3d p, double duration) {
  return std::make_shared<Line>(p, Eigen::Vector3d::Zero(), duration);
}
inline std::shared_ptr<const Motion> driving(Eigen::Vector3d start, Eigen::Vector3d velocity,
                                             double duration) {
  return std::make_shared<Line>(start, velocity, duration);
}

/// Standing, turned by any attitude.
class Posed : public PlainMotion {
 public:
  Posed(Eigen::Vector3d p, Eigen::Quaterniond q, double duration)
      : PlainMotion(duration), p_(p), R_(q.toRotationMatrix()) {}
  Kinematics at(double) const override {
    Kinematics k;
    k.p_map = p_;
    k.R_map_body = R_;
    return k;
  }
  double travelled(double) const override { return 0.0; }

 private:
  Eigen::Vector3d p_;
  Eigen::Matrix3d R_;
};

/// Spec A 3.2: the quarter turn through the L-shaped roadway.
class QuarterTurn : public PlainMotion {
 public:
  QuarterTurn() : PlainMotion(35.0) {}
  Kinematics at(double t) const override {
    const double s = travelled(t);
    const double arc = 1.5 * kPi;
    Kinematics k;
    double yaw = 0.0;
    if (s <= 7.0) {
      k.p_map = {s, 0.0, 0.0};
    } else if (s <= 7.0 + arc) {
      yaw = -(s - 7.0) / 3.0;
      k.p_map = {7.0 - 3.0 * std::sin(yaw), -3.0 + 3.0 * std::cos(yaw), 0.0};
    } else {
      yaw = -0.5 * kPi;
      k.p_map = {10.0, -3.0 - (s - 7.0 - arc), 0.0};
    }
    k.R_map_body = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return k;
  }
  double travelled(double t) const override {
    const double v = 0.3 * kPi;
    const double ramp = 1.14554;
    const double since = std::max(t - 12.0, 0.0);
    return since < ramp ? 0.5 * v * since * since / ramp : v * (since - 0.5 * ramp);
  }
};

inline std::vector<Delivery> drained(SensorStream& stream) {
  std::vector<Delivery> all;
  while (std::optional<Delivery> delivery = stream.next()) all.push_back(*delivery);
  return all;
}

template <typename Wanted>
std::vector<Wanted> readings(const std::vector<Delivery>& deliveries) {
  std::vector<Wanted> all;
  for (const Delivery& delivery : deliveries) all.push_back(std::get<Wanted>(delivery.measurement.reading));
  return all;
}

inline double secondsOf(const Delivery& delivery) {
  return secondsSinceOrigin(delivery.measurement.stamp);
}

/// 3.89 standard deviations leave 1 in 10,000 outside, two-sided.
constexpr double kBand = 3.89;
inline double meanBand(double sigma, std::size_t n) {
  return kBand * sigma / std::sqrt(static_cast<double>(n));
}
/// Of a standard deviation estimated from n normal values.
inline double sigmaBand(double sigma, std::size_t n) {
  return kBand * sigma / std::sqrt(2.0 * static_cast<double>(n));
}
inline double rateBand(double p, std::size_t n) {
  return kBand * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
}

inline double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
inline double sigmaOf(const std::vector<double>& values) {
  const double mean = meanOf(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}
template <typename Test>
double rateOf(const std::vector<double>& values, Test test) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), test)) /
         static_cast<double>(values.size());
}

/// Every bit of a delivery, as text.
struct Spelled {
  std::ostringstream out;
  void operator()(const BeaconRange& r) {
    out << r.tag << ' ' << r.anchor << ' ' << r.range << ' ' << r.rx_power_dbm.value_or(0.0) << ' '
        << r.first_path_power_dbm.value_or(0.0);
  }
  void operator()(const GnssFix& r) {
    out << r.latitude << ' ' << r.longitude << ' ' << r.altitude << ' ' << r.covariance_enu;
  }
  void operator()(const Scan2D& r) {
    out << r.T_body_sensor.rotation.coeffs();
    for (std::size_t i = 0; i < r.ranges.size(); ++i) out << ' ' << r.ranges[i] << ' ' << int{r.valid[i]};
  }
  void operator()(const PassageFix& r) {
    out << r.place << ' ' << r.p_map << ' ' << r.p_body << ' ' << r.covariance;
  }
  template <typename Other>
  void operator()(const Other&) {
    out << "unexpected";
  }
};
inline std::string spelled(const std::vector<Delivery>& deliveries) {
  Spelled text;
  text.out << std::hexfloat;
  for (const Delivery& delivery : deliveries) {
    text.out << delivery.arrival.time_since_epoch().count() << ' '
             << delivery.measurement.stamp.time_since_epoch().count() << ' ' << delivery.measurement.sensor
             << ' ';
    std::visit(text, delivery.measurement.reading);
    text.out << '\n';
  }
  return text.out.str();
}

}  // namespace pos::sim::scene
