#include "pos/interval/lock_safety.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pos/core/random.hpp"

namespace pos::interval {
namespace {

/// Slow oracle: tries every order.
bool someOrderWorks(const LockSite& site, const std::vector<Settled>& vehicles) {
  std::vector<std::size_t> order(vehicles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  do {
    bool works = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Settled& v = vehicles[order[i]];
      for (std::size_t j = i + 1; j < order.size(); ++j) {  // those still there
        const Settled& u = vehicles[order[j]];
        const std::size_t place = u.way->stops[u.stop].stop;
        if (site.stops[place].kind != StopPlace::Kind::OnRoad) continue;
        for (std::size_t k = v.stop; k < v.way->stops.size(); ++k) {
          if (v.way->stops[k].stop != place) continue;
          if (k > v.stop || u.still_to_go < v.still_to_go) works = false;
        }
      }
    }
    if (works) return true;
  } while (std::next_permutation(order.begin(), order.end()));
  return false;
}

}  // namespace

TEST(LockSafety, AgreesWithTryingEveryOrder) {
  RandomStream random(5, 0);
  LockSite site;
  for (int i = 0; i < 6; ++i)
    site.stops.push_back({"S", i < 4 ? StopPlace::Kind::OnRoad : StopPlace::Kind::Niche});
  int safe = 0;
  int unsafe = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<Way> ways(2 + random.bits() % 4);
    for (Way& way : ways) {
      std::vector<std::size_t> stops{0, 1, 2, 3, 4, 5};
      std::shuffle(stops.begin(), stops.end(), random);
      stops.resize(2 + random.bits() % 4);
      for (const std::size_t stop : stops) way.stops.push_back({stop, static_cast<double>(way.stops.size())});
    }
    std::vector<Settled> vehicles;
    for (const Way& way : ways)
      vehicles.push_back({&way, random.bits() % way.stops.size(), random.uniform(0.0, 50.0)});
    const bool expected = someOrderWorks(site, vehicles);
    ASSERT_EQ(everybodyCanFinish(site, vehicles), expected) << round;
    ++(expected ? safe : unsafe);
  }
  EXPECT_GT(safe, 100);
  EXPECT_GT(unsafe, 100);
}

}  // namespace pos::interval
