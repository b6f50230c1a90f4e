#pragma once
/// What logs in MCAP files are written and read by. Private to io.

#include <string_view>

namespace pos::io {

inline constexpr const char* kStaticTransforms = "/tf_static";
inline constexpr std::string_view kTruthTopics = "/ground_truth";  // how topics of reference poses begin

// Keys of a channel's metadata.
inline constexpr const char* kSensorKey = "sensor";  // the label in the log
inline constexpr const char* kContentKey =
    "content";  // kIncrements: the twist's covariance is the increment's
inline constexpr const char* kIncrements = "increments";

}  // namespace pos::io
