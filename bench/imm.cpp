/// One tick of two interacting 15-state filters (mixing both, Bayes, the fuzzy controller, combination)
/// beside the same with full 15x15 transports; and one evaluation of the fuzzy controller.
#include "pos/filters/imm.hpp"
#include "pos/core/random.hpp"
#include "pos/filters/fuzzy.hpp"
#include "pos/ins/eskf_state.hpp"
#include "support.hpp"

namespace {

using namespace pos;
using filters::FuzzyVariant;
using ins::EskfState;

constexpr int kTicks = 1000;

/// The same state without its closed form of the transport: the general one is taken.
struct Plain {
  static constexpr int kDof = 15;
  EskfState x;
};
Plain plus(const Plain& a, const Vector<15>& d) {
  return {ins::plus(a.x, d)};
}
Vector<15> minus(const Plain& to, const Plain& from) {
  return ins::minus(to.x, from.x);
}

filters::Modes<EskfState, 2> modes() {
  RandomStream random(1, 1);
  filters::Modes<EskfState, 2> both;
  for (auto& mode : both) {
    Vector<15> d;
    for (double& v : d) v = random.normal(0.0, 0.01);
    mode.mean = plus(mode.mean, d);
    Matrix<15, 15> A;
    for (double& v : A.reshaped()) v = random.normal(0.0, 0.1);
    mode.covariance = A * A.transpose() + 0.01 * Matrix<15, 15>::Identity();
  }
  return both;
}

const Matrix<2, 2> kPi{{0.95, 0.05}, {0.05, 0.95}};

template <class X>
void ticks(benchmark::State& state, const filters::Modes<X, 2>& start) {
  const filters::FuzzyController fuzzy({.variant = FuzzyVariant::Paper});
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    Vector<2> mu(0.6, 0.4);
    for (int i = 0; i < kTicks; ++i) {
      const auto mixed = filters::mixed<X, 2>(start, filters::mixingWeights<2>(kPi, mu));
      const Vector<2> c = filters::predictedModes<2>(kPi, mu);
      mu = filters::floored<2>(fuzzy.controlled<2>(mu, filters::bayes<2>(c, {-1.0, -1.1})), 1e-3);
      benchmark::DoNotOptimize(filters::combined<X, 2>(mixed, mu));
    }
  }
  timer.report(state, "ns_per_tick", kTicks);
}

void tick_ours(benchmark::State& state) {
  ticks<EskfState>(state, modes());
}

void tick_general(benchmark::State& state) {
  const auto both = modes();
  ticks<Plain>(state, {Belief<Plain>{{both[0].mean}, both[0].covariance},
                       Belief<Plain>{{both[1].mean}, both[1].covariance}});
}

void fuzzy(benchmark::State& state, FuzzyVariant variant) {
  const filters::FuzzyTable table = filters::tableOf({.variant = variant});
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    for (int i = 0; i < kTicks; ++i) {
      const double at = static_cast<double>(i) / kTicks;
      benchmark::DoNotOptimize(filters::evaluated(table, at, 0.9 - 1.7 * at));
    }
  }
  timer.report(state, "ns_per_evaluation", kTicks);
}

BENCHMARK(tick_ours)->Unit(benchmark::kMicrosecond);
BENCHMARK(tick_general)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fuzzy, paper, FuzzyVariant::Paper)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fuzzy, centroid, FuzzyVariant::Centroid)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
