#include <algorithm>
#include <optional>

#include "imu_errors.hpp"
#include "pos/core/error.hpp"
#include "pos/sim/imu.hpp"

namespace pos::sim {
namespace {

constexpr double kRounding = 1e-9;  // s
constexpr double kStanding = 1e-3;  // m/s and rad/s

class ImuStream final : public SensorStream {
 public:
  ImuStream(const ImuModel& model, std::shared_ptr<const Earth> earth, std::shared_ptr<const Motion> motion,
            const RunSetup& run)
      : model_(validated(model)),
        earth_(std::move(earth)),
        motion_(std::move(motion)),
        ticker_(model.timing, run, motion_->duration()),
        gyro_(model.errors.gyro, TriadNoise::Part::Gyros, model.timing, run),
        accelerometer_(model.errors.accelerometer, TriadNoise::Part::Accelerometers, model.timing, run) {}

  std::optional<Delivery> next() override {
    const double interval = 1.0 / model_.timing.rate;
    while (const std::optional<Tick> tick = ticker_.next()) {
      if (!last_t_ && tick->t < interval - kRounding) continue;
      // Errors go on while a sample is lost; the truth of a lost sample is not needed.
      const double from = last_t_.value_or(std::max(0.0, tick->t - interval));
      last_t_ = tick->t;
      const ImuSample sample = sampleOver(from, tick->t);
      if (!tick->lost) return ticker_.sent(tick->t, model_.sensor, sample);
    }
    return std::nullopt;
  }

 private:
  ImuSample sampleOver(double from, double to) {
    const InertialIncrement truth = inertialIncrement(*motion_, *earth_, model_.p_body, from, to);
    const Duration interval = durationFromSeconds(to - from);
    const double dt = seconds(interval);
    const TriadNoise::Ride ride = rideAt(0.5 * (from + to));
    return {.kind = model_.kind,
            .angular = gyro_.reading(truth.angle / dt, dt, model_.kind, ride),
            .linear = accelerometer_.reading(truth.velocity / dt, dt, model_.kind, ride),
            .interval = interval};
  }

  /// Looked at only where it matters: a motion costs more than the errors.
  TriadNoise::Ride rideAt(double t) const {
    const bool matters =
        !model_.errors.gyro.moving_bias.isZero() || !model_.errors.accelerometer.moving_bias.isZero();
    if (!matters) return TriadNoise::Ride::Standing;
    const Kinematics body = motion_->at(t);
    const bool stands = body.v_map.norm() < kStanding && body.omega_body.norm() < kStanding;
    return stands ? TriadNoise::Ride::Standing : TriadNoise::Ride::Moving;
  }

  ImuModel model_;
  std::shared_ptr<const Earth> earth_;
  std::shared_ptr<const Motion> motion_;
  Ticker ticker_;
  TriadNoise gyro_;
  TriadNoise accelerometer_;
  std::optional<double> last_t_ = {};
};

}  // namespace

std::unique_ptr<SensorStream> makeImuStream(const ImuModel& model, std::shared_ptr<const Earth> earth,
                                            std::shared_ptr<const Motion> motion, const RunSetup& run) {
  ensure(earth != nullptr && motion != nullptr, "an inertial unit needs an Earth and a motion");
  return std::make_unique<ImuStream>(model, std::move(earth), std::move(motion), run);
}

}  // namespace pos::sim
