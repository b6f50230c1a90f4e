#include <array>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/sim/encoder.hpp"

namespace pos::sim {
namespace {

enum Purpose : std::uint32_t { kLeft = 2, kYaw = 5, kRight = Ticker::kFirstPurpose + 2 };

/// One wheel: its rim's way becomes counts, and counts become the way that the vehicle's computer believes.
class Wheel {
 public:
  Wheel(const EncoderModel& model, double file_radius, double radius_error)
      : ticks_per_turn_(model.ticks_per_turn),
        modulus_(std::int64_t{1} << model.counter_bits),
        file_radius_(file_radius),
        true_radius_(file_radius / (1.0 + radius_error)) {}

  void roll(double way) { way_ += way; }
  /// Counts since the start, before the counter wraps.
  double counts() const { return std::floor(turns() * ticks_per_turn_); }
  std::int64_t counter() const {
    const auto count = static_cast<std::int64_t>(counts());
    return ((count % modulus_) + modulus_) % modulus_;
  }
  double believedWay() const {
    const double counted = ticks_per_turn_ > 0.0 ? counts() / ticks_per_turn_ : turns();
    return 2.0 * kPi * file_radius_ * counted;
  }

 private:
  double turns() const { return way_ / (2.0 * kPi * true_radius_); }

  double ticks_per_turn_;
  std::int64_t modulus_;
  double file_radius_;
  double true_radius_;
  double way_ = 0.0;
};

/// The motion of an axle whose wheels rolled these ways, on an exact arc.
Pose2 arc(const WheelPair& way, double track) {
  const double turn = (way.right - way.left) / track;
  const double half = 0.5 * turn;
  const double sinc = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const double chord = 0.5 * (way.left + way.right) * sinc;
  return {chord * std::cos(half), chord * std::sin(half), turn};
}

class EncoderStream final : public SensorStream {
 public:
  EncoderStream(const EncoderModel& model, const Vehicle& vehicle, std::shared_ptr<const Motion> motion,
                const RunSetup& run)
      : model_(validated(model)),
        vehicle_(vehicle),
        file_track_(vehicle.encoder_track),
        motion_(std::move(motion)),
        ticker_(model.timing, run, motion_->duration()),
        noises_{randomStream(run, model.timing, kLeft), randomStream(run, model.timing, kRight)},
        yaw_noise_(randomStream(run, model.timing, kYaw)),
        left_(model_, vehicle.wheel_radius, model_.left_radius_error),
        right_(model_, vehicle.wheel_radius, model_.right_radius_error) {
    vehicle_.encoder_track = file_track_ / (1.0 + model_.track_error);
  }

  std::optional<Delivery> next() override {
    while (const std::optional<Tick> tick = ticker_.next()) {
      const bool begun = roll(tick->t);
      if (model_.output == EncoderModel::Output::Ticks) {
        if (!tick->lost) return delivery(tick->t, WheelTicks{left_.counter(), right_.counter()});
      } else if (begun) {
        const Reading reading = readingOverInterval();
        if (!tick->lost) return delivery(tick->t, reading);
      }
    }
    return std::nullopt;
  }

 private:
  /// Turns the wheels up to `t`; false the first time, when no interval lies behind.
  bool roll(double t) {
    const WheelPair way = rimTravel(*motion_, vehicle_, model_.slips, last_t_, t);
    before_ = {left_.believedWay(), right_.believedWay()};
    interval_ = t - last_t_;
    last_t_ = t;
    left_.roll(way.left + microSlip(way.left, noises_[0]));
    right_.roll(way.right + microSlip(way.right, noises_[1]));
    const bool begun = begun_;
    begun_ = true;
    return begun;
  }

  double microSlip(double way, RandomStream& noise) const {
    return model_.distance_noise * std::sqrt(std::abs(way)) * noise.normal();
  }

  Reading readingOverInterval() {
    const WheelPair way{left_.believedWay() - before_.left, right_.believedWay() - before_.right};
    if (model_.output == EncoderModel::Output::Speeds) {
      const double left = way.left / interval_ + model_.speed_sigma * noises_[0].normal();
      return WheelSpeeds{left, way.right / interval_ + model_.speed_sigma * noises_[1].normal()};
    }
    return increment(way);
  }

  /// Motion since the last increment that arrived: what is lost is made up for by the next one.
  OdometryIncrement increment(const WheelPair& way) {
    Pose2 step = arc(way, file_track_);
    step.yaw += model_.yaw_sigma * yaw_noise_.normal();
    since_delivery_ = since_delivery_ * step;
    way_since_delivery_ = {way_since_delivery_.left + way.left, way_since_delivery_.right + way.right};
    time_since_delivery_ += interval_;
    ++steps_since_delivery_;
    OdometryIncrement increment{.increment = since_delivery_,
                                .interval = durationFromSeconds(time_since_delivery_)};
    if (model_.claims_covariance) increment.covariance = covariance();
    return increment;
  }

  /// Micro slip of both wheels, rounding of the counts at both ends (variance quantum^2 / 6), yaw noise.
  Matrix<3, 3> covariance() const {
    const double quantum =
        model_.ticks_per_turn > 0.0 ? 2.0 * kPi * vehicle_.wheel_radius / model_.ticks_per_turn : 0.0;
    const auto variance = [&](double way) {
      return model_.distance_noise * model_.distance_noise * std::abs(way) + quantum * quantum / 6.0;
    };
    const double ahead = 0.5 * (way_since_delivery_.left + way_since_delivery_.right);
    const double half = 0.5 * since_delivery_.yaw;
    Matrix<3, 2> J;  // d [x, y, yaw] / d [left, right]
    for (int side = 0; side < 2; ++side) {
      const double turn = (side == 0 ? -1.0 : 1.0) / file_track_;
      J.col(side) << 0.5 * std::cos(half) - 0.5 * ahead * turn * std::sin(half),
          0.5 * std::sin(half) + 0.5 * ahead * turn * std::cos(half), turn;
    }
    const Eigen::Vector2d variances(variance(way_since_delivery_.left), variance(way_since_delivery_.right));
    Matrix<3, 3> P = J * variances.asDiagonal() * J.transpose();
    P(2, 2) += steps_since_delivery_ * model_.yaw_sigma * model_.yaw_sigma;
    return P;
  }

  Delivery delivery(double t, const Reading& reading) {
    since_delivery_ = {};
    way_since_delivery_ = {};
    time_since_delivery_ = 0.0;
    steps_since_delivery_ = 0;
    return ticker_.sent(t, model_.sensor, reading);
  }

  EncoderModel model_;
  Vehicle vehicle_;  ///< with the true track
  double file_track_;
  std::shared_ptr<const Motion> motion_;
  Ticker ticker_;
  std::array<RandomStream, 2> noises_;
  RandomStream yaw_noise_;
  Wheel left_;
  Wheel right_;
  WheelPair before_ = {};
  double last_t_ = 0.0;
  double interval_ = 0.0;
  bool begun_ = false;
  Pose2 since_delivery_ = {};
  WheelPair way_since_delivery_ = {};
  double time_since_delivery_ = 0.0;
  int steps_since_delivery_ = 0;
};

}  // namespace

std::unique_ptr<SensorStream> makeEncoderStream(const EncoderModel& model, const Vehicle& vehicle,
                                                std::shared_ptr<const Motion> motion, const RunSetup& run) {
  ensure(motion != nullptr, "wheels need a motion");
  // A guided machine may have a haulage wheel that counts: then its vehicle file says how large it is.
  if (!(vehicle.wheel_radius > 0.0) || !(vehicle.encoder_track > 0.0)) {
    refuse("the vehicle has no wheels to count", "sensor", model.sensor, "a vehicle on wheels");
  }
  return std::make_unique<EncoderStream>(model, validated(vehicle), std::move(motion), run);
}

}  // namespace pos::sim
