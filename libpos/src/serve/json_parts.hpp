#pragma once
/// Numbers and stamps in JSON. Private to serve.

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "pos/core/stamp.hpp"

namespace pos::serve {

using Json = nlohmann::ordered_json;

/// JSON knows no infinity and no NaN: null.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
inline Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}
inline Json stampJson(const std::optional<Stamp>& stamp) {
  return stamp ? Json(secondsSinceOrigin(*stamp)) : Json(nullptr);
}
/// On one line; bytes that are no UTF-8, as a log may have in its labels, become the replacement character.
inline std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pos::serve
