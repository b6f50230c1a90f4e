#pragma once
/// Made-up mines for tests of the map: small ones by hand, large ones by chance.

#include <cmath>
#include <memory>
#include <string>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/map/network.hpp"

namespace pos::test {

inline map::Roadway straightRoadway(const std::string& id, const Eigen::Vector3d& from,
                                    const Eigen::Vector3d& to) {
  map::Roadway roadway;
  roadway.id = id;
  roadway.centreline = {{.p_map = from}, {.p_map = to}};
  return roadway;
}

inline map::Network networkOf(map::TunnelMap tunnel_map) {
  return map::Network(std::make_shared<const map::TunnelMap>(std::move(tunnel_map)));
}

/// Roadways of random lines and arcs on three levels, 6 m apart, in a square of 400 m.
inline map::TunnelMap randomMine(std::uint64_t seed, int roadways, int points) {
  RandomStream random(seed, 1);
  map::TunnelMap mine{.name = "random"};
  for (int r = 0; r < roadways; ++r) {
    map::Roadway roadway;
    roadway.id = "R" + std::to_string(r);
    roadway.width = random.uniform(3.0, 7.0);
    roadway.height = random.uniform(3.6, 5.0);
    roadway.section = random.bernoulli(0.5) ? map::Section::Arch : map::Section::Rectangle;
    roadway.chainage_start = random.uniform(-50.0, 50.0);
    Eigen::Vector3d p(random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0), -6.0 * (r % 3));
    double heading = random.uniform(-kPi, kPi);
    for (int i = 0; i < points; ++i) {
      const double arc = random.bernoulli(0.4) ? random.uniform(-1.2, 1.2) : 0.0;
      roadway.centreline.push_back({.p_map = p, .arc = arc});
      const double chord = random.uniform(15.0, 40.0);
      heading += 0.5 * arc;
      p += Eigen::Vector3d(chord * std::cos(heading), chord * std::sin(heading), random.uniform(-1.0, 1.0));
      heading += 0.5 * arc + (random.bernoulli(0.3) ? random.uniform(-0.8, 0.8) : 0.0);
    }
    mine.roadways.push_back(roadway);
  }
  return mine;
}

/// A square field of n + n roadways, 200 m long and 50 m apart; every roadway reaches past its last crossing
/// on both sides. Some go one way.
inline map::TunnelMap gridMine(std::uint64_t seed, int n) {
  RandomStream random(seed, 5);
  map::TunnelMap mine{.name = "grid"};
  for (int i = 0; i < n; ++i) {
    const double at = 25.0 + 50.0 * i;
    mine.roadways.push_back(straightRoadway("H" + std::to_string(i), {0, at, 0}, {200, at, 0}));
    mine.roadways.push_back(straightRoadway("V" + std::to_string(i), {at, 0, 0}, {at, 200, 0}));
  }
  for (map::Roadway& roadway : mine.roadways) {
    const double u = random.uniform();
    roadway.traffic = u < 0.6   ? map::Traffic::BothWays
                      : u < 0.8 ? map::Traffic::ForwardOnly
                                : map::Traffic::BackwardOnly;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const std::string h = "H" + std::to_string(i);
      const std::string v = "V" + std::to_string(j);
      mine.junctions.push_back({.id = h + v, .places = {{h, 25.0 + 50.0 * j}, {v, 25.0 + 50.0 * i}}});
    }
  }
  return mine;
}

}  // namespace pos::test
