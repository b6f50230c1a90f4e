#include "pos/sim/simulation.hpp"

#include <algorithm>

#include "pos/core/config_checks.hpp"
#include "pos/sim/scenario.hpp"
#include "sensor_streams.hpp"

namespace pos::sim {
namespace {

/// A stream with the delivery it will make next.
struct Source {
  std::unique_ptr<SensorStream> stream;
  std::optional<Delivery> ahead;
};

}  // namespace

struct Simulation::Impl {
  std::shared_ptr<const Motion> motion;
  Stamp start;
  double duration = 0.0;
  std::vector<Source> sources;
};

Simulation::Simulation(const Scenario& scenario, std::shared_ptr<const map::TunnelMap> map,
                       std::uint64_t seed)
    : impl_(std::make_unique<Impl>()) {
  const SensorSite site = sensorSite(scenario, std::move(map), seed);
  impl_->motion = site.motion;
  impl_->start = site.run.start;
  impl_->duration = site.duration;
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    auto stream = sensorStream(scenario.sensors[i], indexed("sensors", i), site);
    auto first = stream->next();
    impl_->sources.push_back({std::move(stream), std::move(first)});
  }
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

std::optional<Delivery> Simulation::next() {
  Source* earliest = nullptr;
  for (Source& source : impl_->sources) {  // tens of sensors: a look at each is cheaper than a heap
    if (source.ahead && (earliest == nullptr || source.ahead->arrival < earliest->ahead->arrival)) {
      earliest = &source;
    }
  }
  if (earliest == nullptr) return std::nullopt;
  std::optional<Delivery> delivery = std::move(earliest->ahead);
  earliest->ahead = earliest->stream->next();
  return delivery;
}

Kinematics Simulation::truthAt(double t) const {
  return impl_->motion->at(t);
}
Pose3 Simulation::truthPoseAt(Stamp stamp) const {
  return poseOf(truthAt(seconds(stamp - impl_->start)));
}
const Motion& Simulation::motion() const {
  return *impl_->motion;
}
Stamp Simulation::start() const {
  return impl_->start;
}
double Simulation::duration() const {
  return impl_->duration;
}

TruthSampler::TruthSampler(const Simulation& simulation, double rate)
    : simulation_(&simulation), rate_(rate) {
  requirePositive(rate, "rate", "Hz");
}

std::optional<TruthPose> TruthSampler::next() {
  if (over_) return std::nullopt;
  const double t = static_cast<double>(count_++) / rate_;
  const Stamp end = simulation_->end();
  const Stamp stamp = std::min(simulation_->start() + durationFromSeconds(t), end);
  over_ = stamp >= end;
  return TruthPose{stamp, simulation_->truthPoseAt(stamp)};
}

Truth sampledTruth(const Simulation& simulation, double rate) {
  Truth truth;
  TruthSampler sampler(simulation, rate);
  while (const auto pose = sampler.next()) truth.poses.push_back(*pose);
  return truth;
}

Pose3 poseOf(const Kinematics& body) {
  return {body.p_map, Eigen::Quaterniond(body.R_map_body)};
}

}  // namespace pos::sim
