#include "pos/yardstick/mrpt_mcl.hpp"

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "mrpt_inputs.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/estimation/odometry_sigma.hpp"

namespace pos::yardstick {
namespace {

using mrpt::random::CRandomGenerator;

/// While it lives, the thread's generator is ours.
class OwnRandomNumbers {
 public:
  explicit OwnRandomNumbers(CRandomGenerator& own) : own_(own) {
    std::swap(mrpt::random::getRandomGenerator(), own_);
  }
  ~OwnRandomNumbers() { std::swap(mrpt::random::getRandomGenerator(), own_); }
  OwnRandomNumbers(const OwnRandomNumbers&) = delete;
  OwnRandomNumbers& operator=(const OwnRandomNumbers&) = delete;

 private:
  CRandomGenerator& own_;
};

/// As pos::require, said of the whole filter.
void require(bool holds, const char* key, const char* expected) {
  pos::require(holds, key, expected, "MRPT's particle filter cannot be set up");
}

mrpt::bayes::CParticleFilter particleFilter(const estimation::MrptMclConfig& config) {
  mrpt::bayes::CParticleFilter filter;
  filter.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  // MRPT throws on any other method than multinomial when the size is adaptive.
  filter.m_options.resamplingMethod = config.adaptive_size ? mrpt::bayes::CParticleFilter::prMultinomial
                                                           : mrpt::bayes::CParticleFilter::prSystematic;
  filter.m_options.adaptiveSampleSize = config.adaptive_size;
  filter.m_options.sampleSize = static_cast<unsigned int>(config.particles);
  return filter;
}

/// Rounding in MRPT's sums makes the covariance of a collapsed cloud slightly negative: the nearest that is
/// none.
Matrix<3, 3> semiDefinite(const Matrix<3, 3>& P) {
  const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> eigen(0.5 * (P + P.transpose()));
  const Matrix<3, 3> half = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return half * half.transpose();
}

mrpt::math::TPose2D asMrpt(const Pose2& pose) {
  return {pose.x, pose.y, pose.yaw};
}

}  // namespace

struct MrptMcl::Filter {
  estimation::MrptMclConfig config;
  std::shared_ptr<const map::TunnelMap> map;
  Pose2 T_map_filter;
  CRandomGenerator random;
  mrpt::bayes::CParticleFilter algorithm;
  mutable mrpt::slam::CMonteCarloLocalization2D cloud;
  int beams_in_scan = 0;
  bool started = false;
  Stamp stamp;
  std::optional<Stamp> last_odometry;

  void seed() {
    random = CRandomGenerator(static_cast<std::uint32_t>(config.seed));
    last_odometry.reset();
    started = true;
  }
  void setMap(int beams) {
    beams_in_scan = beams;
    cloud.options.metricMap = metricMap(*map, config, beams);
  }
  void start(Stamp at);
  void startAnywhere();
  void startGaussian(const Belief<Pose2>& prior);
  void execute(const mrpt::obs::CActionCollection* action, const mrpt::obs::CSensoryFrame* frame);
  void observe(const mrpt::obs::CObservation::Ptr& observation);

  IngestReport take(const OdometryIncrement& odometry, Stamp at);
  IngestReport take(const BeaconRange& range, Stamp at);
  IngestReport take(const Scan2D& scan, Stamp at);
  template <class Other>
  IngestReport take(const Other&, Stamp) {
    return {.verdict = Verdict::Unsupported, .reason = "kind not used"};
  }
};

void MrptMcl::Filter::startGaussian(const Belief<Pose2>& prior) {
  const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> eigen(prior.covariance);
  const Matrix<3, 3> root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  cloud.resetDeterministic(mrpt::math::TPose2D(), static_cast<std::size_t>(config.particles));
  for (auto& particle : cloud.m_particles) {
    Vector<3> n;
    for (int i = 0; i < 3; ++i) n[i] = random.drawGaussian1D_normalized();
    particle.d = asMrpt(inverse(T_map_filter) * plus(prior.mean, root * n));
  }
}

void MrptMcl::Filter::startAnywhere() {
  const OwnRandomNumbers own(random);
  if (map->grid && config.use_scans) {
    auto maps = metricMap(*map, config, 1);
    cloud.resetUniformFreeSpace(maps->mapByClass<mrpt::maps::COccupancyGridMap2D>().get(), 0.7,
                                config.particles);
    return;
  }
  Eigen::Vector2d low = map->anchors.front().p_map.head<2>();
  Eigen::Vector2d high = low;
  for (const map::Anchor& anchor : map->anchors) {
    low = low.cwiseMin(anchor.p_map.head<2>());
    high = high.cwiseMax(anchor.p_map.head<2>());
  }
  const double margin = 0.5 * (high - low).norm();
  cloud.resetUniform(low.x() - margin, high.x() + margin, low.y() - margin, high.y() + margin, -kPi, kPi,
                     config.particles);
}

void MrptMcl::Filter::start(Stamp at) {
  seed();
  stamp = at;
  const estimation::StartConfig& prior = config.start;
  if (prior.mode == estimation::StartMode::Unknown) return startAnywhere();
  const Vector<3> sigma(prior.position_sigma, prior.position_sigma, prior.yaw_sigma);
  startGaussian({prior.pose, sigma.cwiseAbs2().asDiagonal()});
  if (prior.mode == estimation::StartMode::Known) return;
  for (auto& particle : cloud.m_particles) particle.d.phi = random.drawUniform(-kPi, kPi);
}

void MrptMcl::Filter::execute(const mrpt::obs::CActionCollection* action,
                              const mrpt::obs::CSensoryFrame* frame) {
  const OwnRandomNumbers own(random);
  algorithm.executeOn(cloud, action, frame);
  cloud.normalizeWeights();  // else a far outlier makes every weight underflow
}

void MrptMcl::Filter::observe(const mrpt::obs::CObservation::Ptr& observation) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  execute(nullptr, &frame);
}

IngestReport MrptMcl::Filter::take(const OdometryIncrement& odometry, Stamp at) {
  if (!started) start(at);
  const Duration interval = odometry.interval.value_or(last_odometry ? at - *last_odometry : Duration{0});
  const Vector<3> sigma =
      estimation::incrementSigma(config.odometry_noise, odometry.increment, std::max(0.0, seconds(interval)));
  mrpt::poses::CPosePDFGaussian change;
  change.mean = mrpt::poses::CPose2D(asMrpt(odometry.increment));
  change.cov.setZero();
  for (int i = 0; i < 3; ++i) change.cov(i, i) = sigma[i] * sigma[i];
  mrpt::obs::CActionRobotMovement2D movement;
  movement.motionModelConfiguration.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
  mrpt::obs::CActionCollection action;
  action.insert(movement);
  execute(&action, nullptr);
  last_odometry = at;
  stamp = at;
  return {.verdict = Verdict::Applied};
}

IngestReport MrptMcl::Filter::take(const BeaconRange& range, Stamp at) {
  const map::Anchor* anchor = map->findAnchor(range.anchor);
  if (anchor == nullptr) return {.verdict = Verdict::Degenerate, .reason = "the map has no such anchor"};
  if (!started) start(at);
  Eigen::Vector3d tag = range.tag_body.value_or(Eigen::Vector3d::Zero());
  for (const estimation::TagMount& mount : config.tags) {
    if (mount.id == range.tag) tag = mount.p_body;
  }
  tag.z() += config.body_height;
  observe(beaconObservation(range, tag, range.range - anchor->range_bias));
  stamp = at;
  return {.verdict = Verdict::Applied};
}

IngestReport MrptMcl::Filter::take(const Scan2D& scan, Stamp at) {
  if (!started) start(at);
  const auto beams = static_cast<int>(scan.ranges.size());
  if (beams != beams_in_scan) setMap(beams);  // MRPT thins beams by a fixed step kept in its map
  observe(scanObservation(scan, config.body_height));
  stamp = at;
  return {.verdict = Verdict::Applied};
}

MrptMcl::MrptMcl(const estimation::MrptMclConfig& config, std::shared_ptr<const map::TunnelMap> map) {
  require(map != nullptr, "map", "a map");
  require(config.use_ranges || config.use_scans, "use_ranges", "use_ranges or use_scans (or both)");
  require(!config.use_ranges || !map->anchors.empty(), "use_ranges", "a map with anchors");
  require(!config.use_scans || map->grid.has_value(), "use_scans", "a map with an occupancy grid");
  require(config.particles > 0 && config.beams > 0, "particles", "particles and beams above 0");
  require(config.range_sigma > 0.0, "range_sigma", "above 0 m");
  const Pose2 frame = filterFrame(*map, config);
  filter_ = std::make_unique<Filter>(Filter{.config = config,
                                            .map = std::move(map),
                                            .T_map_filter = frame,
                                            .random = CRandomGenerator(1),
                                            .algorithm = particleFilter(config),
                                            .cloud = {},
                                            .stamp = {},
                                            .last_odometry = {}});
  filter_->cloud.options.KLD_params.KLD_maxSampleSize = static_cast<unsigned int>(config.particles);
  filter_->cloud.options.KLD_params.KLD_binSize_PHI = radians(10.0);
  filter_->setMap(config.beams);
}

MrptMcl::~MrptMcl() = default;

void MrptMcl::reset(Stamp stamp, const Belief<Pose2>& prior) {
  filter_->seed();
  filter_->stamp = stamp;
  filter_->startGaussian(prior);
}

IngestReport MrptMcl::ingest(const Measurement& measurement) {
  const auto unsupported = [&] {
    if (std::holds_alternative<BeaconRange>(measurement.reading)) return !filter_->config.use_ranges;
    if (std::holds_alternative<Scan2D>(measurement.reading)) return !filter_->config.use_scans;
    return !std::holds_alternative<OdometryIncrement>(measurement.reading);
  };
  if (unsupported()) return {.verdict = Verdict::Unsupported, .reason = "kind not used"};
  if (defect(measurement)) return {.verdict = Verdict::Degenerate, .reason = "defective reading"};
  if (filter_->started && measurement.stamp < filter_->stamp) {
    return {.verdict = Verdict::TooOld, .reason = "too old"};
  }
  return std::visit([&](const auto& reading) { return filter_->take(reading, measurement.stamp); },
                    measurement.reading);
}

std::optional<Estimate> MrptMcl::estimateAt(Stamp stamp) const {
  if (!filter_->started || stamp < filter_->stamp) return {};
  const auto [covariance, mean] = filter_->cloud.getCovarianceAndMean();
  const Pose2 T_filter_body{mean.x(), mean.y(), mean.phi()};
  Matrix<3, 3> turn = Matrix<3, 3>::Identity();
  turn.topLeftCorner<2, 2>() = rotation2(filter_->T_map_filter.yaw);
  Matrix<3, 3> P;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) P(row, column) = covariance(row, column);
  }
  return planarEstimate(stamp, filter_->T_map_filter * T_filter_body,
                        semiDefinite(turn * P * turn.transpose()), filter_->config.body_height);
}

Diagnostics MrptMcl::diagnostics() const {
  return {{"particles", static_cast<double>(filter_->cloud.particlesCount())},
          {"effective_size", filter_->started ? filter_->cloud.ESS() : 0.0}};
}

}  // namespace pos::yardstick
