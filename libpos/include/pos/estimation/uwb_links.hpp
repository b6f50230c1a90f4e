#pragma once
/// Which radio links a dual-tag estimator uses: where the tag sits, where the anchor stands, what the link
/// reads too long.

#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pos/core/verdict.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/map/tunnel_map.hpp"
#include "pos/uwb/rigid.hpp"

namespace pos::estimation {

/// One range ready for a model: corrected, with everything known of its link.
struct UwbReading {
  int tag = 0;           ///< index of the tag, in the order configured or heard
  int anchor = 0;        ///< index of the anchor in the map
  uwb::BodyRange range;  ///< bias taken off; sigma with the survey's share
};

/// A reading, or why there is none.
struct UwbLookUp {
  Verdict verdict = Verdict::Applied;
  std::string_view reason = {};
  UwbReading reading = {};
};

class UwbLinks {
 public:
  /// Throws ConfigError when the map has no anchors, or a listed bias names an anchor that is not there.
  /// Biases and shifts of tags that are not used do no harm: one table serves every choice of tags.
  UwbLinks(const DualUwbConfig& config, const map::TunnelMap& map);

  /// Learns the place of a tag from the log where the configuration lists none.
  UwbLookUp find(const BeaconRange& range);

  int anchors() const { return static_cast<int>(anchors_.size()); }
  int tags() const { return static_cast<int>(tags_.size()); }
  const TagMount& tag(int index) const { return tags_[static_cast<std::size_t>(index)]; }
  AnchorId anchorId(int index) const { return anchors_[static_cast<std::size_t>(index)].id; }

 private:
  int tagIndex(const BeaconRange& range);
  double biasOf(TagId tag, AnchorId anchor) const;

  struct Slot {
    AnchorId id = 0;
    Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
    double sigma = 0.0;
    std::vector<double> bias;  // by tag index
  };
  DualUwbConfig config_;
  std::vector<double> map_bias_;
  std::vector<Slot> anchors_;
  std::unordered_map<AnchorId, int> index_;
  std::vector<TagMount> tags_;
};

/// Is the place on the ground where the vehicle can be: inside the configured corners, and on a free cell of
/// the map's grid? Where neither is given, everywhere is.
class RoadwayTest {
 public:
  RoadwayTest(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map)
      : corners_(config.roadway), map_(std::move(map)) {}
  bool inside(const Eigen::Vector2d& p_map) const;
  /// Says anything at all.
  bool known() const { return !corners_.empty() || map_->grid.has_value(); }

 private:
  std::vector<Eigen::Vector2d> corners_;
  std::shared_ptr<const map::TunnelMap> map_;
};

}  // namespace pos::estimation
