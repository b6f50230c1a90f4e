#include "pos/estimation/dual_uwb_models.hpp"

#include <cmath>
#include <string>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/core/square.hpp"

namespace pos::estimation {
namespace {

using State = DualUwbState;

/// rad/s, and its derivative by the row of the rate (the gyro's bias counts against it).
struct Rate {
  double value;
  double by_state;
};

Rate rateOf(const State& x, const DualUwbLayout& layout, GyroInput gyro) {
  const double state = x.values[layout.rateRow()];
  return layout.gyro() ? Rate{gyro.rate - state, -1.0} : Rate{state, 1.0};
}

LinkStep linkStep(const LinkBiasState& bias, double dt) {
  if (bias.time <= 0.0) return {1.0, bias.value, square(bias.walk_per_sqrt_s) * dt};
  const double keep = std::exp(-dt / bias.time);
  return {keep, bias.value, square(bias.sigma) * (1.0 - keep * keep)};
}

/// A measurement that only the given rows see.
DualUwbRow emptyRow(const State& x, double nu) {
  DualUwbRow row;
  row.nu[0] = nu;
  row.H = TangentRows<State, 1>::Zero(1, x.values.size());
  return row;
}

}  // namespace

DualUwbState plus(const DualUwbState& x, const Tangent<DualUwbState>& d) {
  DualUwbState result{x.values + d};
  result.values[2] = wrapAngle(result.values[2]);
  return result;
}

Tangent<DualUwbState> minus(const DualUwbState& to, const DualUwbState& from) {
  Tangent<DualUwbState> d = to.values - from.values;
  d[2] = wrapAngle(d[2]);
  return d;
}

DualUwbLayout::DualUwbLayout(const DualUwbConfig& config, int anchors)
    : vehicle_(config.motion == DualUwbConfig::Motion::Vehicle),
      gyro_(config.variant == DualUwbConfig::Variant::FilterGyro),
      anchors_(anchors),
      core_(vehicle_ ? 5 : 6),
      links_(config.link_bias.sigma > 0.0 ? static_cast<int>(config.tags.size()) * anchors : 0) {
  if (size() <= State::kMaxDof) return;
  throw ConfigError(Complaint{
      .what = "too many links for one bias state each",
      .key = "link_bias.sigma_m",
      .got = std::to_string(config.tags.size()) + " tags and " + std::to_string(anchors) + " anchors",
      .expected = "at most " + std::to_string(State::kMaxDof - core_) + " links",
      .suggestion = "calibrate the ranges instead: pos calibrate ranges"});
}

DualUwbStep DualUwbMotion::standing(const DualUwbState& x, double dt) const {
  const int n = layout->core();
  return {x.values.head(n), DualUwbStep::Core::Identity(n, n), DualUwbStep::Core::Zero(n, n),
          linkStep(config->link_bias, dt)};
}

DualUwbStep DualUwbMotion::step(const DualUwbState& x, GyroInput gyro, double dt) const {
  DualUwbStep step = standing(x, dt);
  const int rate_row = layout->rateRow();
  const Rate rate = rateOf(x, *layout, gyro);
  const double q_a = square(config->acceleration_density);
  const double q_alpha = square(config->yaw_acceleration_density);

  step.next[2] = wrapAngle(x.values[2] + rate.value * dt);
  step.F(2, rate_row) = rate.by_state * dt;
  if (layout->gyro()) {
    // the gyro's own noise, and what the true rate may have changed by since the sample
    const double wander = q_alpha * (std::pow(gyro.age + dt, 3) - std::pow(gyro.age, 3)) / 3.0;
    step.Qd(2, 2) = square(config->gyro_noise) * dt + wander;
    step.Qd(rate_row, rate_row) = square(config->gyro_bias.walk_per_sqrt_s) * dt;
  } else {
    step.Qd(2, 2) = q_alpha * dt * dt * dt / 3.0;
    step.Qd(2, rate_row) = step.Qd(rate_row, 2) = q_alpha * dt * dt / 2.0;
    step.Qd(rate_row, rate_row) = q_alpha * dt;
  }

  if (!layout->vehicle()) {
    for (int axis = 0; axis < 2; ++axis) {
      const int v = DualUwbLayout::velocityRow() + axis;
      step.next[axis] += dt * x.values[v];
      step.F(axis, v) = dt;
      step.Qd(axis, axis) = q_a * dt * dt * dt / 3.0;
      step.Qd(axis, v) = step.Qd(v, axis) = q_a * dt * dt / 2.0;
      step.Qd(v, v) = q_a * dt;
    }
    return step;
  }

  const int v = DualUwbLayout::velocityRow();
  const double half_turned = 0.5 * rate.value * dt;
  const double heading = x.values[2] + half_turned;
  const Eigen::Vector2d course(std::cos(heading + config->course_offset),
                               std::sin(heading + config->course_offset));
  const Eigen::Vector2d left(-std::sin(heading), std::cos(heading));
  const double speed = x.values[v];
  const double sideways = rate.value * config->motion_centre_x;
  const Eigen::Vector2d velocity = speed * course + sideways * left;
  const Eigen::Vector2d velocity_by_heading(-velocity.y(), velocity.x());
  step.next.head<2>() += dt * velocity;
  step.F.topRightCorner(2, layout->core() - 2).col(0) = dt * velocity_by_heading;
  step.F.block<2, 1>(0, v) = dt * course;
  step.F.block<2, 1>(0, rate_row) =
      rate.by_state * dt * (config->motion_centre_x * left + 0.5 * dt * velocity_by_heading);
  step.Qd.topLeftCorner<2, 2>() = q_a * dt * dt * dt / 3.0 * course * course.transpose();
  step.Qd.block<2, 1>(0, v) = q_a * dt * dt / 2.0 * course;
  step.Qd.block<1, 2>(v, 0) = step.Qd.block<2, 1>(0, v).transpose();
  step.Qd(v, v) = q_a * dt;
  return step;
}

void predict(Belief<DualUwbState>& belief, const DualUwbStep& step) {
  const auto core = step.next.size();
  auto& P = belief.covariance;
  const auto links = P.rows() - core;
  belief.mean.values.head(core) = step.next;
  const DualUwbStep::Core turned = step.F * P.topLeftCorner(core, core);
  P.topLeftCorner(core, core).noalias() = turned * step.F.transpose();
  P.topLeftCorner(core, core) += step.Qd;
  auto pose = P.topLeftCorner(core, core);
  filters::symmetrise(pose);
  if (links == 0) return;
  const double keep = step.links.keep;
  auto biases = belief.mean.values.tail(links);
  biases.array() = step.links.mean + keep * (biases.array() - step.links.mean);
  P.topRightCorner(core, links) = (keep * step.F * P.topRightCorner(core, links)).eval();
  P.bottomLeftCorner(links, core) = P.topRightCorner(core, links).transpose();
  if (keep != 1.0) P.bottomRightCorner(links, links) *= keep * keep;
  P.diagonal().tail(links).array() += step.links.variance;
}

DualUwbRow rangeInnovation(const DualUwbState& x, const DualUwbLayout& layout, const uwb::BodyRange& range,
                           double body_height, int tag, int anchor) {
  const uwb::RangeRow predicted =
      uwb::predictedRange(x.pose(), body_height, range.tag_body, range.anchor_map);
  DualUwbRow row = emptyRow(x, range.range - predicted.distance);
  row.H.head<3>() = predicted.row.transpose();
  if (const auto link = layout.linkRow(tag, anchor)) {
    row.nu[0] -= x.values[*link];
    row.H(*link) = 1.0;
  }
  return row;
}

DualUwbRow wheelInnovation(const DualUwbState& x, const DualUwbLayout& layout, const DualUwbConfig& config,
                           double speed, GyroInput gyro) {
  const int v = DualUwbLayout::velocityRow();
  if (layout.vehicle()) {
    DualUwbRow row = emptyRow(x, speed - x.values[v]);
    row.H(v) = 1.0;
    return row;
  }
  // v' c - rate * centre * (left' c): the turning's own share along the course, zero without an offset
  const double direction = x.values[2] + config.course_offset;
  const Eigen::Vector2d course(std::cos(direction), std::sin(direction));
  const Rate rate = rateOf(x, layout, gyro);
  const double share = config.motion_centre_x * std::sin(config.course_offset);
  const Eigen::Vector2d velocity = x.values.segment<2>(v);
  DualUwbRow row = emptyRow(x, speed - velocity.dot(course) + rate.value * share);
  row.H(2) = velocity.dot(Eigen::Vector2d(-course.y(), course.x()));
  row.H.segment<2>(v) = course.transpose();
  row.H(layout.rateRow()) = -rate.by_state * share;
  return row;
}

DualUwbRow lateralInnovation(const DualUwbState& x, const DualUwbLayout& layout, const DualUwbConfig& config,
                             GyroInput gyro) {
  const int v = DualUwbLayout::velocityRow();
  const double direction = x.values[2] + config.course_offset;
  const Eigen::Vector2d across(-std::sin(direction), std::cos(direction));
  const Rate rate = rateOf(x, layout, gyro);
  const double lever = config.motion_centre_x * std::cos(config.course_offset);  // left' across
  const Eigen::Vector2d velocity = x.values.segment<2>(v);
  DualUwbRow row = emptyRow(x, rate.value * lever - velocity.dot(across));
  row.H(2) = -velocity.dot(Eigen::Vector2d(std::cos(direction), std::sin(direction)));
  row.H.segment<2>(v) = across.transpose();
  row.H(layout.rateRow()) = -rate.by_state * lever;
  return row;
}

PlanarTwist twistOf(const Belief<DualUwbState>& belief, const DualUwbLayout& layout,
                    const DualUwbConfig& config, GyroInput gyro) {
  const State& x = belief.mean;
  const int v = DualUwbLayout::velocityRow();
  const Rate rate = rateOf(x, layout, gyro);
  PlanarTwist twist;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, State::kMaxDof> J =
      Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, State::kMaxDof>::Zero(3, layout.size());
  J(2, layout.rateRow()) = rate.by_state;
  if (layout.vehicle()) {
    const double c = std::cos(config.course_offset);
    const double s = std::sin(config.course_offset);
    twist.rates << c * x.values[v], s * x.values[v] + config.motion_centre_x * rate.value, rate.value;
    J(0, v) = c;
    J(1, v) = s;
    J(1, layout.rateRow()) = config.motion_centre_x * rate.by_state;
  } else {
    const Eigen::Matrix2d R_body_map = rotation2(x.values[2]).transpose();
    const Eigen::Vector2d v_body = R_body_map * x.values.segment<2>(v);
    twist.rates << v_body, rate.value;
    J.col(2).head<2>() << v_body.y(), -v_body.x();
    J.block<2, 2>(0, v) = R_body_map;
  }
  twist.covariance = J * belief.covariance * J.transpose();
  if (layout.gyro()) twist.covariance(2, 2) += square(config.yaw_acceleration_density) * gyro.age;
  return twist;
}

}  // namespace pos::estimation
