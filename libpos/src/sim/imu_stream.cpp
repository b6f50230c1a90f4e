#include "imu_errors.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/sim/imu.hpp"

namespace pos::sim {
namespace {

constexpr double kRounding = 1e-9;  // s

class ImuStream final : public SensorStream {
 public:
  ImuStream(const ImuModel& model, std::shared_ptr<const Earth> earth, const StreamContext& context)
      : model_(validated(model)),
        earth_(std::move(earth)),
        context_(context),
        interval_(1.0 / model.timing.rate),
        clock_(model.timing, context.seed, context.start),
        gyro_(model.errors.gyro, context.seed, 0, interval_),
        accelerometer_(model.errors.accelerometer, context.seed, 1, interval_) {}

  std::optional<Delivery> next() override {
    for (SensorClock::Tick tick = clock_.next(); tick.t <= context_.duration + kRounding;
         tick = clock_.next()) {
      if (tick.t < interval_ - kRounding) continue;
      // Errors go on while a sample is lost; the truth of a lost sample is not needed.
      const double from = std::max(0.0, begun_ ? last_t_ : tick.t - interval_);
      begun_ = true;
      last_t_ = tick.t;
      const ImuSample sample = sampleOver(from, tick.t);
      if (!tick.lost) return Delivery{tick.arrival, {tick.stamp, model_.sensor, sample}};
    }
    return std::nullopt;
  }

 private:
  ImuSample sampleOver(double from, double to) {
    const InertialIncrement truth = inertialIncrement(*context_.motion, *earth_, model_.p_body, from, to);
    return {.kind = model_.kind,
            .angular = gyro_.reading(truth.angle / interval_, model_.kind),
            .linear = accelerometer_.reading(truth.velocity / interval_, model_.kind),
            .interval = durationFromSeconds(interval_)};
  }

  ImuModel model_;
  std::shared_ptr<const Earth> earth_;
  StreamContext context_;
  double interval_;
  SensorClock clock_;
  TriadNoise gyro_;
  TriadNoise accelerometer_;
  double last_t_ = 0.0;
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<SensorStream> makeImuStream(const ImuModel& model, std::shared_ptr<const Earth> earth,
                                            const StreamContext& context) {
  ensure(earth != nullptr && context.motion != nullptr, "an inertial unit needs an Earth and a motion");
  return std::make_unique<ImuStream>(model, std::move(earth), context);
}

}  // namespace pos::sim
