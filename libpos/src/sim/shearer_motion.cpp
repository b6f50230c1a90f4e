#include <algorithm>
#include <cmath>

#include "conveyor.hpp"
#include "curve.hpp"
#include "pos/core/config_checks.hpp"
#include "quadrature.hpp"

namespace pos::sim {
namespace {

/// One run of the shearer along the face, or a standstill.
struct Leg {
  double start = 0.0;       ///< s
  AnglePiece station = {};  ///< its value is a station, m: speed goes up, stays and goes down
  int pass = 0;
  int line = 0;
  bool on_s_bend = false;           ///< outbound in an end operation
  double end_station = 0.0;         ///< of the end operation
  std::vector<double> panels = {};  ///< stations between which the way is cached, in the order driven
  std::vector<double> ways = {};    ///< m travelled at each of them
};

/// Share of the time on which the speed grows: from D = a r (1 - r) T^2.
double rampShare(double way, double time, double acceleration) {
  return 0.5 * (1.0 - std::sqrt(1.0 - 4.0 * way / (acceleration * time * time)));
}

AnglePiece drive(double from, double to, double time, double acceleration) {
  const double way = std::abs(to - from);
  const double ramp = way > 0.0 ? time * rampShare(way, time, acceleration) : 0.0;
  return {
      .start = from, .length = time, .change = {.by = to - from, .blend = Blend::Trapezoid, .ramp = ramp}};
}

/// Derivatives by station of the heading and the pitch of the tangent.
struct TangentAngles {
  Jet heading = {};
  Jet pitch = {};
};

TangentAngles tangentAngles(const LinePoint& at) {
  const Eigen::Vector2d a = at.d1.head<2>();
  const Eigen::Vector2d b = at.d2.head<2>();
  const Eigen::Vector2d c = at.d3.head<2>();
  const double h2 = a.squaredNorm();
  const double h = std::sqrt(h2);
  const double h_d1 = a.dot(b) / h;
  const double h_d2 = (b.squaredNorm() + a.dot(c) - h_d1 * h_d1) / h;
  const double n2 = h2 + at.d1.z() * at.d1.z();
  TangentAngles angles{{.value = std::atan2(a.y(), a.x())}, {.value = std::atan2(at.d1.z(), h)}};
  angles.heading.rate = (a.x() * b.y() - a.y() * b.x()) / h2;
  angles.heading.bend = (a.x() * c.y() - a.y() * c.x()) / h2 - 2.0 * angles.heading.rate * h_d1 / h;
  angles.pitch.rate = (at.d2.z() * h - at.d1.z() * h_d1) / n2;
  angles.pitch.bend = (at.d3.z() * h - at.d1.z() * h_d2) / n2 -
                      2.0 * angles.pitch.rate * (h * h_d1 + at.d1.z() * at.d2.z()) / n2;
  return angles;
}

Jet overTime(const Jet& by_station, const Jet& station) {
  return {by_station.value, by_station.rate * station.rate,
          by_station.bend * station.rate * station.rate + by_station.rate * station.bend};
}

class Shearer final : public ShearerMotion {
 public:
  explicit Shearer(const ShearerConfig& config) : config_(config), conveyor_(config) {
    for (int pass = 0; pass < config_.passes; ++pass) addPass(pass);
    for (const Leg& leg : legs_) starts_.push_back(leg.start);
    addBreaks();
  }

  Kinematics at(double t) const override {
    const Leg& leg = legAt(t);
    const Jet station = stationOf(leg, t);
    const LinePoint point = pointOf(leg, station.value);
    const TangentAngles angles = tangentAngles(point);
    Kinematics body = attitudeOf(overTime(angles.heading, station), overTime(angles.pitch, station));
    body.p_map = point.p;
    body.v_map = point.d1 * station.rate;
    body.a_map = point.d2 * station.rate * station.rate + point.d1 * station.bend;
    return body;
  }
  double duration() const override { return duration_; }
  double travelled(double t) const override {
    const Leg& leg = legAt(t);
    const double station = stationOf(leg, t).value;
    std::size_t i = 0;
    const auto passed = [&](double edge) {
      return std::abs(edge - leg.station.start) <= std::abs(station - leg.station.start);
    };
    while (i + 2 < leg.panels.size() && passed(leg.panels[i + 1])) ++i;
    return leg.ways[i] + wayBetween(leg, leg.panels[i], station);
  }
  const std::vector<double>& breaks() const override { return breaks_; }

  double stationAt(double t) const override { return stationOf(legAt(t), t).value; }
  int lineAt(double t) const override { return legAt(t).pass; }
  Eigen::Vector3d pointOnLine(int line, double station) const override {
    return conveyor_.on(line, station).p;
  }
  int supportLine(double station, double t) const override {
    const Leg& leg = legAt(t);
    const double forward = leg.pass % 2 == 0 ? 1.0 : -1.0;
    // In the end operation the pass is over: the shearer's lag counts from the end it reached.
    const bool in_pass = leg.start == passStart(leg.pass);
    const double reached = in_pass ? stationAt(t) : endOf(leg.pass);
    if (forward * (reached - station) > config_.support_lag) return leg.pass + 1;
    if (in_pass) return leg.pass;
    const bool s_bend_passed =
        !leg.on_s_bend ? leg.line != leg.pass : std::abs(stationAt(t) - leg.end_station) >= config_.s_bend_to;
    return leg.pass + (s_bend_passed ? 1 : 0);
  }

 private:
  double passStart(int pass) const { return pass * (config_.pass_time + config_.dwell_time); }
  double endOf(int pass) const { return pass % 2 == 0 ? config_.pass_length : 0.0; }

  void addPass(int pass) {
    const double end = endOf(pass);
    const double begin = config_.pass_length - end;
    duration_ = passStart(pass);
    addLeg(
        {.station = drive(begin, end, config_.pass_time, config_.acceleration), .pass = pass, .line = pass});
    if (pass + 1 == config_.passes) return;
    const double away = end + (end > 0.0 ? -config_.excursion : config_.excursion);
    const double time = 0.5 * (config_.dwell_time - 3.0 * config_.standstill);
    addRest(pass, pass, end);
    addLeg({.station = drive(end, away, time, config_.acceleration),
            .pass = pass,
            .line = pass,
            .on_s_bend = true,
            .end_station = end});
    addRest(pass, pass + 1, away);
    addLeg({.station = drive(away, end, time, config_.acceleration), .pass = pass, .line = pass + 1});
    addRest(pass, pass + 1, end);
  }

  void addRest(int pass, int line, double station) {
    if (config_.standstill <= 0.0) return;
    addLeg({.station = {.start = station, .length = config_.standstill}, .pass = pass, .line = line});
  }

  void addLeg(Leg leg) {
    leg.start = duration_;
    duration_ += leg.station.length;
    const double from = leg.station.start;
    const double by = leg.station.change.by;
    const int count = 1 + static_cast<int>(std::abs(by) / 10.0);
    for (int i = 0; i <= count; ++i) leg.panels.push_back(from + by * i / count);
    if (leg.on_s_bend) {
      for (const double d : {config_.s_bend_from, config_.s_bend_to})
        leg.panels.push_back(from + std::copysign(d, by));
      std::sort(leg.panels.begin(), leg.panels.end(),
                [from](double a, double b) { return std::abs(a - from) < std::abs(b - from); });
    }
    double way = legs_.empty() ? 0.0 : legs_.back().ways.back();
    leg.ways.push_back(way);
    for (std::size_t i = 0; i + 1 < leg.panels.size(); ++i) {
      way += wayBetween(leg, leg.panels[i], leg.panels[i + 1]);
      leg.ways.push_back(way);
    }
    legs_.push_back(std::move(leg));
  }

  void addBreaks() {
    std::vector<double> breaks;
    for (const Leg& leg : legs_) {
      breaks.push_back(leg.start);
      for (const double x : leg.station.corners()) breaks.push_back(leg.start + x);
      if (!leg.on_s_bend) continue;
      for (const double d : {config_.s_bend_from, config_.s_bend_to}) breaks.push_back(timeAway(leg, d));
    }
    breaks_ = tidied(std::move(breaks), 0.0, duration_);
  }

  /// When an outbound leg is `away` metres from its end, by bisection.
  static double timeAway(const Leg& leg, double away) {
    double low = 0.0;
    double high = leg.station.length;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (std::abs(leg.station.at(middle).value - leg.end_station) < away ? low : high) = middle;
    }
    return leg.start + 0.5 * (low + high);
  }

  const Leg& legAt(double t) const { return legs_[pieceIndex(starts_, t)]; }
  Jet stationOf(const Leg& leg, double t) const {
    const Jet jet = leg.station.at(std::clamp(t - leg.start, 0.0, leg.station.length));
    return t < 0.0 || t > duration_ ? Jet{.value = jet.value} : jet;
  }
  LinePoint pointOf(const Leg& leg, double station) const {
    return leg.on_s_bend ? conveyor_.between(leg.line, station, leg.end_station)
                         : conveyor_.on(leg.line, station);
  }
  double wayBetween(const Leg& leg, double from, double to) const {
    return integral10([&](double station) { return pointOf(leg, station).d1.norm(); }, from, to);
  }

  ShearerConfig config_;
  Conveyor conveyor_;
  std::vector<Leg> legs_;
  std::vector<double> starts_;
  std::vector<double> breaks_;
  double duration_ = 0.0;
};

void requireDrivable(double way, double time, const ShearerConfig& config, const std::string& key) {
  if (time > 0.0 && 4.0 * way < config.acceleration * time * time) return;
  refuse("the way cannot be driven in its time", key,
         std::to_string(way) + " m in " + std::to_string(time) + " s", "more time or acceleration");
}

}  // namespace

ShearerConfig validated(const ShearerConfig& config) {
  if (config.passes < 1) refuse("no passes", "passes", std::to_string(config.passes), ">= 1");
  requirePositive(config.pass_length, "pass_length");
  requirePositive(config.pass_time, "pass_time");
  requireNotNegative(config.dwell_time, "dwell_time");
  requirePositive(config.acceleration, "acceleration");
  requireNotNegative(config.standstill, "standstill");
  requireNotNegative(config.bend_peak, "bend_peak");
  requireNotNegative(config.floor_peak, "floor_peak");
  requireShare(config.inherited, "inherited");
  requireNotNegative(config.support_lag, "support_lag");
  requireFinite(config.advance, "advance");
  for (const double creep : config.creep) requireFinite(creep, "creep");
  requireDrivable(config.pass_length, config.pass_time, config, "pass_time");
  if (config.passes == 1) return config;
  if (!(config.s_bend_from >= 0.0 && config.s_bend_from < config.s_bend_to &&
        config.s_bend_to <= config.excursion && config.excursion <= config.pass_length)) {
    refuse("the S-bend does not lie within the excursion", "s_bend_to", std::to_string(config.s_bend_to),
           "s_bend_from < s_bend_to <= excursion <= pass_length");
  }
  requireDrivable(config.excursion, 0.5 * (config.dwell_time - 3.0 * config.standstill), config,
                  "dwell_time");
  return config;
}

std::unique_ptr<ShearerMotion> makeShearerMotion(const ShearerConfig& config) {
  return std::make_unique<Shearer>(validated(config));
}

}  // namespace pos::sim
