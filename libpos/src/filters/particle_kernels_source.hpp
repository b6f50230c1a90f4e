#pragma once
/// The loops of particle_kernels.hpp, for the instruction set of the file that includes this.

#include "particle_kernels.hpp"
#include "pos/core/lanes_math.hpp"

namespace pos::filters::kernel {
namespace {

using namespace pos::lanes;

constexpr float kLeastWeight = 1e-30F;  // filters/particle_set.hpp

/// Noise of the 64 particles from `first` on: normal k of particle 16 v + i lies at [3 v + k][i]. Three calls
/// of the generator give four normals each to sixteen lanes.
void fillNormals(float (*normals)[kGroup], std::size_t first, const Philox& stream) {
  for (std::uint32_t call = 0; call < 3; ++call) {
    for (std::size_t p = 0; p < kParts; ++p) {
      Words counter = {};
      for (std::size_t i = 0; i < kWidth; ++i) counter[i] = static_cast<std::uint32_t>(kWidth * p + i);
      counter += static_cast<std::uint32_t>(first / 64 * 48) + 16 * call;
      const FourWords words = randomWords(counter, stream);
      const NormalPair a = normalPair(words.of[0], words.of[1]);
      const NormalPair b = normalPair(words.of[2], words.of[3]);
      store(normals[4 * call] + kWidth * p, a.first);
      store(normals[4 * call + 1] + kWidth * p, a.second);
      store(normals[4 * call + 2] + kWidth * p, b.first);
      store(normals[4 * call + 3] + kWidth * p, b.second);
    }
  }
}

/// Sixteen particles from `at` on, with their rows of normals.
POS_LANE_FUNCTION void moveGroup(const Motion& m, std::size_t at, const float (*normals)[kGroup]) {
  for (std::size_t p = 0; p < kParts; ++p) {
    const std::size_t i = at + kWidth * p;
    const Floats along = m.step[0] + m.sigma[0] * load(normals[0] + kWidth * p);
    const Floats across = m.step[1] + m.sigma[1] * load(normals[1] + kWidth * p);
    const Floats turn = m.step[2] + m.sigma[2] * load(normals[2] + kWidth * p);
    const Floats yaw = load(m.yaw + i);
    const SineCosine before = sineCosine(yaw);
    store(m.x + i, load(m.x + i) + (before.cosine * along - before.sine * across));
    store(m.y + i, load(m.y + i) + (before.sine * along + before.cosine * across));
    const Floats after = wrapped(yaw + turn);
    const SineCosine heading = sineCosine(after);
    store(m.yaw + i, after);
    store(m.cosine + i, heading.cosine);
    store(m.sine + i, heading.sine);
  }
}

/// Where the last few particles are taken to when they are fewer than sixteen; zeros fill it up.
struct Spare {
  float of[5][kGroup] = {};
};

void moveLast(const Motion& m, std::size_t at, std::size_t count, const float (*normals)[kGroup]) {
  Spare spare;
  float* const arrays[5] = {m.x, m.y, m.yaw, m.cosine, m.sine};
  for (int k = 0; k < 3; ++k) __builtin_memcpy(spare.of[k], arrays[k] + at, count * sizeof(float));
  Motion last = m;
  last.x = spare.of[0];
  last.y = spare.of[1];
  last.yaw = spare.of[2];
  last.cosine = spare.of[3];
  last.sine = spare.of[4];
  moveGroup(last, 0, normals);
  for (int k = 0; k < 5; ++k) __builtin_memcpy(arrays[k] + at, spare.of[k], count * sizeof(float));
}

void move(const Motion& m) {
  const Philox stream{{static_cast<std::uint32_t>(m.seed), static_cast<std::uint32_t>(m.seed >> 32)},
                      {static_cast<std::uint32_t>(m.number), static_cast<std::uint32_t>(m.number >> 32),
                       0x6d6f7665U}};  // a stream of its own
  const std::size_t end = m.first + m.count;
  alignas(64) float normals[12][kGroup];
  for (std::size_t block = m.first; block < end; block += 64) {
    fillNormals(normals, block, stream);
    for (std::size_t v = 0; v < 4; ++v) {
      const std::size_t at = block + kGroup * v;
      if (at + kGroup <= end) {
        moveGroup(m, at, normals + 3 * v);
      } else if (at < end) {
        moveLast(m, at, end - at, normals + 3 * v);
      }
    }
  }
}

POS_LANE_FUNCTION void headingGroup(const float* yaw, float* cosine, float* sine) {
  for (std::size_t p = 0; p < kParts; ++p) {
    const SineCosine heading = sineCosine(load(yaw + kWidth * p));
    store(cosine + kWidth * p, heading.cosine);
    store(sine + kWidth * p, heading.sine);
  }
}

void headings(const float* yaw, float* cosine, float* sine, std::size_t count) {
  std::size_t i = 0;
  for (; i + kGroup <= count; i += kGroup) headingGroup(yaw + i, cosine + i, sine + i);
  if (i == count) return;
  Spare spare;
  const std::size_t bytes = (count - i) * sizeof(float);
  __builtin_memcpy(spare.of[0], yaw + i, bytes);
  headingGroup(spare.of[0], spare.of[1], spare.of[2]);
  __builtin_memcpy(cosine + i, spare.of[1], bytes);
  __builtin_memcpy(sine + i, spare.of[2], bytes);
}

WeightSums weightSums(const float* weight, std::size_t count) {
  Sum first;
  Sum second;
  const auto add = [&](const float* w16) __attribute__((always_inline)) {
    for (std::size_t p = 0; p < kParts; ++p) {
      const Floats w = load(w16 + kWidth * p);
      first.add(p, w);
      second.add(p, w * w);
    }
  };
  std::size_t i = 0;
  for (; i + kGroup <= count; i += kGroup) add(weight + i);
  if (i < count) {
    Spare spare;
    __builtin_memcpy(spare.of[0], weight + i, (count - i) * sizeof(float));
    add(spare.of[0]);
  }
  return {first.total(), second.total()};
}

void scale(float* weight, std::size_t count, float factor) {
  std::size_t i = 0;
  for (; i + kWidth <= count; i += kWidth) {
    store(weight + i, larger(load(weight + i) * factor, all(kLeastWeight)));
  }
  for (; i < count; ++i) {
    const float w = weight[i] * factor;
    weight[i] = w > kLeastWeight ? w : kLeastWeight;
  }
}

float largest(const float* value, std::size_t count) {
  Floats top = all(value[0]);
  std::size_t i = 0;
  for (; i + kWidth <= count; i += kWidth) top = larger(top, load(value + i));
  float most = top[0];
  for (std::size_t k = 1; k < kWidth; ++k) most = top[k] > most ? top[k] : most;
  for (; i < count; ++i) most = value[i] > most ? value[i] : most;
  return most;
}

WeightSums weigh(const Weighing& task) {
  const Weighing t = task;
  Sum before;
  Sum after;
  const auto add = [&](const float* weight, float* value) __attribute__((always_inline)) {
    for (std::size_t p = 0; p < kParts; ++p) {
      const Floats w = load(weight + kWidth * p);
      const Floats product = w * power2((load(value + kWidth * p) - t.top) * t.slope);
      before.add(p, w);
      after.add(p, product);
      store(value + kWidth * p, larger(product, all(kLeastWeight)));
    }
  };
  std::size_t i = 0;
  for (; i + kGroup <= t.count; i += kGroup) add(t.weight + i, t.value + i);
  if (i < t.count) {
    Spare spare;
    const std::size_t bytes = (t.count - i) * sizeof(float);
    __builtin_memcpy(spare.of[0], t.weight + i, bytes);
    __builtin_memcpy(spare.of[1], t.value + i, bytes);
    add(spare.of[0], spare.of[1]);
    __builtin_memcpy(t.value + i, spare.of[1], bytes);
  }
  return {before.total(), after.total()};
}

/// Runs `add(view)` over groups of sixteen; in the last one those that do not exist weigh nothing.
template <class Add>
POS_LANE_FUNCTION void overGroups(const CloudView& view, const Add& add) {
  std::size_t i = 0;
  for (; i + kGroup <= view.count; i += kGroup) {
    add(view.x + i, view.y + i, view.yaw + i, view.weight + i);
  }
  if (i == view.count) return;
  Spare spare;
  const float* const arrays[4] = {view.x, view.y, view.yaw, view.weight};
  for (int k = 0; k < 4; ++k) {
    __builtin_memcpy(spare.of[k], arrays[k] + i, (view.count - i) * sizeof(float));
  }
  add(spare.of[0], spare.of[1], spare.of[2], spare.of[3]);
}

DirectionSums directions(const CloudView& view) {
  Sum weight, x, y, cosine, sine;
  overGroups(
      view, [&](const float* px, const float* py, const float* pyaw, const float* pw)
                __attribute__((always_inline)) {
                  for (std::size_t p = 0; p < kParts; ++p) {
                    const std::size_t i = kWidth * p;
                    const Floats w = load(pw + i);
                    const SineCosine heading = sineCosine(load(pyaw + i));
                    weight.add(p, w);
                    x.add(p, w * (load(px + i) - view.x0));
                    y.add(p, w * (load(py + i) - view.y0));
                    cosine.add(p, w * heading.cosine);
                    sine.add(p, w * heading.sine);
                  }
                });
  return {weight.total(), x.total(), y.total(), cosine.total(), sine.total()};
}

SpreadSums spread(const CloudView& view) {
  Sum xx, xy, yy, xa, ya, aa;
  overGroups(
      view, [&](const float* px, const float* py, const float* pyaw, const float* pw)
                __attribute__((always_inline)) {
                  for (std::size_t p = 0; p < kParts; ++p) {
                    const std::size_t i = kWidth * p;
                    const Floats dx = load(px + i) - view.x0;
                    const Floats dy = load(py + i) - view.y0;
                    const Floats da = wrapped(load(pyaw + i) - view.yaw0);
                    const Floats w = load(pw + i);
                    xx.add(p, w * dx * dx);
                    xy.add(p, w * dx * dy);
                    yy.add(p, w * dy * dy);
                    xa.add(p, w * dx * da);
                    ya.add(p, w * dy * da);
                    aa.add(p, w * da * da);
                  }
                });
  return {xx.total(), xy.total(), yy.total(), xa.total(), ya.total(), aa.total()};
}

}  // namespace
}  // namespace pos::filters::kernel
