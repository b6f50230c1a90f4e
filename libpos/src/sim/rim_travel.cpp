#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/sim/encoder.hpp"
#include "quadrature.hpp"

namespace pos::sim {
namespace {

bool touches(const SlipEvent& slip, SlipEvent::Side side) {
  return slip.side == SlipEvent::Side::Both || slip.side == side;
}

double rimSpeed(const SlipEvent& slip, double ground, double t) {
  switch (slip.kind) {
    case SlipEvent::Kind::Ratio:
      return (1.0 + slip.ratio) * ground;
    case SlipEvent::Kind::Free:
      return slip.speed + slip.amplitude * std::sin(2.0 * kPi * slip.frequency * (t - slip.window.from));
    case SlipEvent::Kind::LockUp:
      break;
  }
  return 0.0;
}

/// Rim speeds at `t`, an inner point of a stretch on which no slip begins or ends.
WheelPair rimSpeeds(const WheelPair& ground, const std::vector<SlipEvent>& slips, double t) {
  WheelPair rim = ground;
  for (const SlipEvent& slip : slips) {
    if (!slip.window.contains(t)) continue;
    if (touches(slip, SlipEvent::Side::Left)) rim.left = rimSpeed(slip, ground.left, t);
    if (touches(slip, SlipEvent::Side::Right)) rim.right = rimSpeed(slip, ground.right, t);
  }
  return rim;
}

/// Ends of smooth stretches inside (from, to), ascending, then `to`.
std::vector<double> edgesWithin(const Motion& motion, const std::vector<SlipEvent>& slips, double from,
                                double to) {
  const std::vector<double>& breaks = motion.breaks();
  std::vector<double> edges(std::upper_bound(breaks.begin(), breaks.end(), from),
                            std::lower_bound(breaks.begin(), breaks.end(), to));
  for (const SlipEvent& slip : slips) {
    for (const double edge : {slip.window.from, slip.window.to}) {
      if (edge > from && edge < to) edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.push_back(to);
  return edges;
}

void requireUsable(const SlipEvent& slip, const std::string& key) {
  requireSpan(slip.window, key + ".window");
  if (!(slip.ratio >= -1.0) || !std::isfinite(slip.ratio)) {
    refuse("a rim cannot turn against the ground by a ratio", key + ".ratio", std::to_string(slip.ratio),
           ">= -1");
  }
  requireFinite(slip.speed, key + ".speed");
  requireFinite(slip.amplitude, key + ".amplitude");
  requireNotNegative(slip.frequency, key + ".frequency");
}

void requireApart(const std::vector<SlipEvent>& slips) {
  for (std::size_t i = 0; i < slips.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool same_side = touches(slips[i], slips[j].side) || touches(slips[j], slips[i].side);
      const bool at_once =
          slips[i].window.from < slips[j].window.to && slips[j].window.from < slips[i].window.to;
      if (same_side && at_once) {
        refuse("two slips of one wheel overlap", "slips[" + std::to_string(i) + "].window",
               std::to_string(slips[i].window.from) + " s",
               "windows apart from those of slips[" + std::to_string(j) + "]");
      }
    }
  }
}

}  // namespace

EncoderModel validated(const EncoderModel& model) {
  if (model.sensor.empty()) refuse("the sensor has no name", "sensor", "", "a name");
  validated(model.timing);
  requireNotNegative(model.ticks_per_turn, "ticks_per_turn");
  if (model.output == EncoderModel::Output::Ticks) requirePositive(model.ticks_per_turn, "ticks_per_turn");
  if (model.counter_bits < 1 || model.counter_bits > 62) {
    refuse("no such counter", "counter_bits", std::to_string(model.counter_bits), "1 to 62");
  }
  for (const auto& [value, key] : {std::pair(model.left_radius_error, "left_radius_error"),
                                   std::pair(model.right_radius_error, "right_radius_error"),
                                   std::pair(model.track_error, "track_error")}) {
    if (!(std::abs(value) < 0.5))
      refuse("an error of half the value", key, std::to_string(value), "-0.5 to 0.5");
  }
  requireNotNegative(model.distance_noise, "distance_noise");
  requireNotNegative(model.speed_sigma, "speed_sigma");
  requireNotNegative(model.yaw_sigma, "yaw_sigma");
  for (std::size_t i = 0; i < model.slips.size(); ++i) requireUsable(model.slips[i], indexed("slips", i));
  requireApart(model.slips);
  return model;
}

WheelPair rimTravel(const Motion& motion, const Vehicle& vehicle, const std::vector<SlipEvent>& slips,
                    double from, double to) {
  constexpr double kPanel = 0.02;  // s
  WheelPair way;
  double start = from;
  for (const double edge : edgesWithin(motion, slips, from, to)) {
    threeNodes(start, edge, kPanel, [&](double t, double weight) {
      const WheelPair speed = rimSpeeds(wheelGroundSpeeds(vehicle, motion.at(t)), slips, t);
      way.left += weight * speed.left;
      way.right += weight * speed.right;
    });
    start = edge;
  }
  return way;
}

}  // namespace pos::sim
