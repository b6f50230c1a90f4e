#pragma once

namespace pos {

constexpr double square(double value) {
  return value * value;
}

}  // namespace pos
