#include "pos/estimation/shearer_filter.hpp"

#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"

namespace pos::estimation {
namespace {

constexpr int kFirstStop = -1000000;  // ids of stops: this, and one less for end 2
constexpr double kUnknown = 1e4;      // m
constexpr double kWatch = 0.04;       // s between looks at where in its cycle the shearer is

int stopId(int end) {
  return kFirstStop - end;
}

bool isLeg(const Landmark& landmark) {
  return landmark.id > kFirstStop;
}

}  // namespace

ShearerFilter::ShearerFilter(const ShearerConfig& config, int mode, Initialisation how)
    : config_(config),
      mode_(mode),
      how_(how),
      arm_(config.legs.place - config.imu_place),
      origin_(config.face.x, config.face.y),
      along_(std::cos(config.face.heading), std::sin(config.face.heading)),
      window_(config.selection, config.legs.spacing, mode),
      progress_(config.face, config.selection.zone_lag),
      lattice_(config.legs.spacing, config.legs.association_gate),
      gate_(chiSquareQuantile(config.legs.confidence, 3.0)) {}

void ShearerFilter::start(const ins::Earth& earth, const ins::NavigationState& nav,
                          const Eigen::Matrix<double, 15, 15>& P) {
  ShearerState x;
  x.earth = earth;
  x.nav = nav;
  x.sensor_states = config_.scanner.use;
  belief_.mean = x;
  belief_.covariance.setZero(x.dof(), x.dof());
  belief_.covariance.topLeftCorner<15, 15>() = P;
  if (x.sensor_states) {
    const ScannerStates& s = config_.scanner;
    LegSensorTangent sigma;
    sigma << s.mount_yaw_sigma, s.mount_pitch_sigma, s.scale_sigma, s.offset_sigma, s.angle_scale_sigma,
        s.angle_curve_sigma;
    belief_.covariance.diagonal().segment<LegSensor::kDof>(x.sensorRow()) = sigma.cwiseAbs2();
  }
  belief_.by_yaw.resize(0);
  if (config_.picm.use == PicmConfig::Use::Continue) belief_.by_yaw.setZero(x.dof());
  first_ = before_ = nav;
  lattice_ = SupportLattice(config_.legs.spacing, config_.legs.association_gate);
  progress_.start(station());
  last_ = {};
  unpropagated_ = unwatched_ = unaided_ = 0.0;
  straight_at_ = station();
  rack_.reset();
  rack_compared_ = swept_ = false;
  if (config_.end_fix.stroke_sigma > 0.0) (void)addStop(belief_, stopId(progress_.end() == 2 ? 1 : 2));
}

ins::ImuIncrement ShearerFilter::corrected(const ins::ImuIncrement& raw) const {
  const ShearerState& x = belief_.mean;
  return {raw.angle - raw.dt * x.gyro_bias, raw.velocity - raw.dt * x.accelerometer_bias, raw.dt};
}

FaceProgress::Event ShearerFilter::step(const ins::ImuIncrement& raw) {
  if (unpropagated_ == 0.0) before_ = belief_.mean.nav;
  const ins::ImuIncrement now = corrected(raw);
  ins::NavigationState& nav = belief_.mean.nav;
  nav = ins::stepped(belief_.mean.earth, nav, ins::compensated(now, last_));
  last_ = now;
  unpropagated_ += now.dt;
  unaided_ += now.dt;
  unwatched_ += now.dt;
  swept_ = false;
  if (unpropagated_ >= config_.propagation_interval - 1e-9) catchUp();
  if (unwatched_ < kWatch - 1e-9) return FaceProgress::Event::None;
  const double dt = unwatched_;
  unwatched_ = 0.0;
  return watchFace(dt);
}

void ShearerFilter::catchUp() {
  propagate(belief_, before_, config_.imu, unpropagated_);
  unpropagated_ = 0.0;
}

// ---------------------------------------------------------------- ends

FaceProgress::Event ShearerFilter::watchFace(double dt) {
  const double speed = along_.dot(belief_.mean.nav.v_n.head<2>());
  const FaceProgress::Event event = progress_.step(station(), speed, dt);
  if (event == FaceProgress::Event::Arrived) arrived();
  alongCut();
  compareRack();
  return event;
}

void ShearerFilter::arrived() {
  catchUp();
  const int end = progress_.end();
  const EndFixConfig& fix = config_.end_fix;
  const bool surveyed =
      fix.first_cut_lateral_sigma + fix.first_cut_along_sigma + fix.first_cut_height_sigma > 0.0;
  if (progress_.arrivals() == 1 && end == 2 && surveyed) {
    fixPlace(Eigen::Vector3d(fix.first_cut_lateral, config_.face.length, fix.first_cut_height),
             {fix.first_cut_lateral_sigma, fix.first_cut_along_sigma, fix.first_cut_height_sigma});
  }
  if (fix.stroke_sigma > 0.0) closeLoop(end);
}

/// A cut runs along its line, within what it strays; the line moves by the advances.
void ShearerFilter::alongCut() {
  const EndFixConfig& fix = config_.end_fix;
  if (!progress_.inPass() || fix.straight_sigma <= 0.0) return;
  if (std::abs(station() - straight_at_) < fix.straight_every) return;
  straight_at_ = station();
  catchUp();
  const int line = progress_.arrivals();
  const double share = station() / config_.face.length;
  const double lateral = share * fix.first_cut_lateral + line * config_.face.advance;
  const double sigma = std::sqrt(square(fix.straight_sigma) + line * square(fix.stroke_sigma));
  fixPlace(Eigen::Vector3d(lateral, 0.0, 0.0), {sigma, 0.0, 0.0});
}

/// The odometer's length against the filter's, where along the face the end of the first cut is surveyed:
/// until it is there. Once, since all that an odometer reads is too long by the same share: a second time
/// would tell nothing new.
void ShearerFilter::compareRack() {
  constexpr double kAfter = 100.0;  // m from the start
  constexpr double kLag = 0.01;     // m, the odometer's last reading is older than the state
  const bool due = rack_ && !rack_compared_ && config_.end_fix.first_cut_along_sigma > 0.0;
  if (!due || progress_.arrivals() > 0 || *rack_ < kAfter) return;
  rack_compared_ = true;
  catchUp();
  const double sigma = std::hypot(config_.odometer.scale_sigma * *rack_, kLag);
  fixPlace(Eigen::Vector3d(0.0, *rack_, 0.0), {0.0, sigma, 0.0});
}

/// `place` and `sigma`: right of the line from end 1, along it, above the start; m. Sigma 0: not known.
void ShearerFilter::fixPlace(const Eigen::Vector3d& place, const Eigen::Vector3d& sigma) {
  const Eigen::Vector3d along(along_.x(), along_.y(), 0.0);
  const Eigen::Vector3d right(along_.y(), -along_.x(), 0.0);
  Eigen::Matrix3d axes;
  axes << right, along, Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d variance =
      (sigma.array() > 0.0).select(sigma.array().square(), square(kUnknown)).matrix();
  const Eigen::Matrix3d R = axes * variance.asDiagonal() * axes.transpose();
  correct(belief_, placeInnovation(belief_.mean, first_.coordinates + axes * place), R,
          std::numeric_limits<double>::infinity());
}

/// Between two visits of an end the conveyor advanced twice, and crept along by what nobody says here.
void ShearerFilter::closeLoop(int end) {
  const Eigen::Vector3d along(along_.x(), along_.y(), 0.0);
  const Eigen::Vector3d right(along_.y(), -along_.x(), 0.0);
  if (const auto stop = belief_.mean.indexOf(stopId(end))) {
    // The last arrival at this end was before two end operations; the start before one.
    const int advances = progress_.arrivals() == 2 ? 1 : 2;
    const Eigen::Vector3d offset = advances * config_.face.advance * right;
    const double across = advances * square(config_.end_fix.stroke_sigma);
    const Eigen::Matrix3d R = across * right * right.transpose() + 1e8 * along * along.transpose() +
                              1e8 * Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
    correct(belief_, stopInnovation(belief_.mean, *stop, offset), R, gate_);
    removeLandmark(belief_, *belief_.mean.indexOf(stopId(end)));
  }
  (void)addStop(belief_, stopId(end));
}

double ShearerFilter::picmAngle() const {
  // Shearer's axes at the start as computed: forward, left, up.
  const Eigen::Quaterniond q_n_m = first_.q_n_b * quaternionFromRotationVector(config_.picm.body_mount);
  const Eigen::Vector3d moved_m = q_n_m.conjugate() * (belief_.mean.nav.coordinates - first_.coordinates);
  return -moved_m.y() / config_.face.length;
}

void ShearerFilter::turnMount(double eta) {
  belief_.mean.sensor.yaw += eta;
  if (belief_.by_yaw.size() == 0) return;
  inject(belief_.mean, -eta * belief_.by_yaw);
  belief_.by_yaw.resize(0);
}

// ---------------------------------------------------------------- legs

int ShearerFilter::legs() const {
  int count = 0;
  for (int i = 0; i < belief_.mean.landmark_count; ++i)
    count += isLeg(belief_.mean.landmarks[static_cast<std::size_t>(i)]) ? 1 : 0;
  return count;
}

LegScene ShearerFilter::expectedLegs() const {
  constexpr double kInView = 14.0;  // m along the face, as far as a scanner of 15 m sees the row
  const ShearerState& x = belief_.mean;
  const Eigen::Vector3d right(along_.y(), -along_.x(), 0.0);
  LegScene scene;
  const int first =
      static_cast<int>(std::ceil((station() - kInView - lattice_.stationOf(0)) / config_.legs.spacing));
  for (int number = first; lattice_.stationOf(number) <= station() + kInView; ++number) {
    const double leg_station = lattice_.stationOf(number);
    const auto known = x.indexOf(number);
    const Eigen::Vector3d beside = x.nav.coordinates +
                                   (leg_station - station()) * Eigen::Vector3d(along_.x(), along_.y(), 0.0) -
                                   config_.legs.lateral * right;
    const Eigen::Vector3d p = known ? expectedLeg(x, *known, arm_) : inScanner(x, beside, arm_);
    scene.expected.push_back({number, p.head<2>(), progress_.mayHaveMoved(leg_station)});
  }
  return scene;
}

void ShearerFilter::dropOutOfSight() {
  const ShearerState& x = belief_.mean;
  for (int i = x.landmark_count - 1; i >= 0; --i) {
    const Landmark& landmark = x.landmarks[static_cast<std::size_t>(i)];
    if (!isLeg(landmark)) continue;
    const double leg_station = along_.dot(landmark.p_n.head<2>() - origin_);
    const bool kept = window_.keeps(progress_.travel(), expectedLeg(x, i, arm_).x()) &&
                      !progress_.mayHaveMoved(leg_station);
    if (!kept) removeLandmark(belief_, i);
  }
}

LegReport ShearerFilter::see(const Eigen::Vector3d& measured, const Eigen::Matrix3d& covariance, double age) {
  if (!swept_) dropOutOfSight();
  swept_ = true;
  const LegSight sight{measured, covariance, age};
  const ShearerState& x = belief_.mean;
  const Eigen::Vector3d seen = estimation::corrected(measured, x.sensor).p;
  for (int i = 0; i < x.landmark_count; ++i) {
    if (!isLeg(x.landmarks[static_cast<std::size_t>(i)])) continue;
    const Eigen::Vector3d away = expectedLeg(x, i, arm_) - seen;
    if (away.head<2>().norm() < config_.legs.association_gate) return update(i, sight);
  }
  if (!window_.takesUp(progress_.travel(), seen.x()))
    return {.verdict = Verdict::Unsupported, .reason = "not one of the legs that the mode of selection uses"};
  if (std::abs(seen.y() - config_.legs.lateral) > config_.legs.lateral_gate)
    return {.verdict = Verdict::Gated, .reason = "no leg stands so near, or so far off, the conveyor"};
  return takeUp(sight);
}

LegReport ShearerFilter::update(int index, const LegSight& sight) {
  catchUp();
  const Eigen::Matrix3d C = belief_.mean.nav.C_n_b();
  const auto told = correct(belief_, legInnovation(belief_.mean, sight, index, arm_),
                            C * sight.covariance * C.transpose(), gate_);
  Landmark& landmark = belief_.mean.landmarks[static_cast<std::size_t>(index)];
  LegReport report{.verdict = told.verdict, .nis = told.nis};
  if (told.verdict == Verdict::Applied) {
    landmark.rejected = 0;
    unaided_ = 0.0;
    return report;
  }
  report.reason = "the leg is not where it stood";
  if (++landmark.rejected >= config_.legs.rejections) removeLandmark(belief_, index);
  return report;
}

LegReport ShearerFilter::takeUp(const LegSight& sight) {
  const Eigen::Vector3d p_n = placeOf(belief_.mean, sight, arm_);
  const double leg_station = along_.dot(p_n.head<2>() - origin_);
  if (progress_.mayHaveMoved(leg_station))
    return {.verdict = Verdict::Unsupported, .reason = "the support may have moved in this cycle"};
  const auto number = lattice_.numberAt(leg_station);
  if (!number) return {.verdict = Verdict::Gated, .reason = "between two supports: not clear which leg"};
  if (belief_.mean.indexOf(*number))
    return {.verdict = Verdict::Gated, .reason = "a second leg where one support stands"};
  catchUp();
  if (!addLandmark(belief_, *number, sight, arm_, how_))
    return {.verdict = Verdict::Unsupported, .reason = "no room for another leg"};
  lattice_.found(*number, leg_station);
  return {.verdict = Verdict::Applied, .taken_up = true};
}

}  // namespace pos::estimation
