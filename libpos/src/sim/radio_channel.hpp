#pragma once
/// The state of the radio links of one vehicle: who is hidden, by how much ranges are off. Private to sim.

#include <vector>

#include "pos/map/tunnel_map.hpp"
#include "pos/sim/radio_errors.hpp"
#include "pos/sim/rock_plan.hpp"
#include "pos/sim/uwb_stream.hpp"

namespace pos::sim {

/// Random numbers of a sensor by kind and running number of a device or link.
RandomStream linkRandom(const RunSetup& run, const Timing& timing, std::uint32_t kind, std::size_t number);

/// What a spell of hiding adds to a range, m.
struct Hiding {
  bool hidden = false;
  double bias = 0.0;

  void add(double other_bias) { *this = {true, hidden ? std::max(bias, other_bias) : other_bias}; }
};

/// Follows NlosProcess for one anchor. Times must not go back.
class HidingProcess {
 public:
  HidingProcess(const NlosProcess& law, RandomStream random);
  Hiding at(double t);

 private:
  void turn();

  NlosProcess law_;
  RandomStream random_;
  Hiding now_ = {};
  double until_ = 0.0;
};

/// Follows NlosBlocks for one anchor. Times must not go back.
class HidingBlocks {
 public:
  HidingBlocks(const NlosBlocks& law, RandomStream random) : law_(law), random_(random) {}
  Hiding at(double t);

 private:
  NlosBlocks law_;
  RandomStream random_;
  Hiding now_ = {};
  std::int64_t block_ = -1;
};

/// Everything RadioErrors does to the link of one tag and one anchor at a time.
class RadioChannel {
 public:
  RadioChannel(const UwbConfig& config, const std::vector<map::Anchor>& anchors, const RunSetup& run,
               LineOfSight line_of_sight);

  struct Path {
    bool heard = true;
    bool hidden = false;
    double excess = 0.0;  ///< m, what hiding, multipath and outliers add to the way of the signal
  };
  /// The link of tag and anchor (positions in their lists). Takes the same random numbers whatever it says.
  Path path(std::size_t tag, std::size_t anchor, double t, const Eigen::Vector3d& tag_map,
            const Eigen::Vector3d& anchor_map);
  /// (1 + scale) range + offset of this link.
  double distorted(std::size_t tag, std::size_t anchor, double range) const;

 private:
  struct Link {
    double scale = 0.0;
    double offset = 0.0;
    bool behind_rock = false;
    double rock_bias = 0.0;
    RandomStream faults;
    RandomStream rock;
  };
  struct AnchorState {
    std::vector<HidingProcess> process;  // at most one
    std::vector<HidingBlocks> blocks;    // at most one
  };
  std::size_t number(std::size_t tag, std::size_t anchor) const { return tag * anchors_.size() + anchor; }
  Link newLink(std::size_t tag, std::size_t anchor, const UwbConfig& config, const RunSetup& run) const;
  Hiding anchorHiding(std::size_t anchor, double t);
  void rock(Link& link, bool clear, Path& path, Hiding& hiding);
  bool silenced(std::size_t tag, std::size_t anchor, double t) const;

  RadioErrors errors_;
  std::vector<TagId> tags_;
  std::vector<AnchorId> anchors_;
  LineOfSight line_of_sight_;
  std::vector<Link> links_;
  std::vector<AnchorState> states_;
  std::vector<double> episode_bias_;
};

}  // namespace pos::sim
