#pragma once
/// Sections, stops and ways for the lock engine, made from the map.

#include <memory>
#include <optional>
#include <vector>

#include "pos/interval/lock_events.hpp"
#include "pos/map/lock_intervals.hpp"
#include "pos/map/routes.hpp"

namespace pos::interval {

struct LockMapRules {
  double bay_margin = 10.0;      ///< m, the road belongs to a chamber this far beyond both of its ends
  double junction_reach = 15.0;  ///< m of every road at a junction that belong to the junction
  double stop_line = 10.0;  ///< m, on two lanes the reference point waits this far before the junction's part
  double queue_length = 80.0;  ///< m, longest queue on one lane before a junction
  double queue_margin =
      15.0;  ///< m of that queue left free, so that the last one's rear clears what is behind
};
LockMapRules validated(LockMapRules rules);

/// A roadway with one lane is cut at its passing chambers, each chamber with the road before it being a
/// section of its own; a roadway with two lanes has a section for each lane; a junction is one section, which
/// two vehicles share only when they make the same turn. All are cut at the ends of the lock intervals too.
class LockMap {
 public:
  LockMap(const map::Network& network, const map::RoadGraph& graph,
          const std::vector<map::LockInterval>& intervals, const LockMapRules& rules);

  std::shared_ptr<const LockSite> site() const { return site_; }
  /// Throws DataError for a route that does not begin and end at an open end or a portal, where the vehicles
  /// are taken to be off the road.
  Way way(const map::RouteLine& route) const;

 private:
  /// A piece of an edge outside its junctions, in chainage.
  struct Piece {
    double from = 0.0;
    double to = 0.0;
    std::size_t forward = 0;   ///< section when driven along the chainage
    std::size_t backward = 0;  ///< the same one where there is only one lane
  };
  struct Place {
    std::size_t stop = 0;
    double from = 0.0;  ///< m, chainage
    double at = 0.0;
    double to = 0.0;
    std::optional<map::Direction> only = {};
  };
  struct Edge {
    double from = 0.0;  ///< m, chainage where the first junction's part ends
    double to = 0.0;    ///< m, chainage where the last one's begins
    std::vector<Piece> pieces = {};
    std::vector<Place> places = {};
  };
  struct DrivenEdge {
    std::size_t edge = 0;
    map::Direction direction = map::Direction::Forward;
  };

  void addJunctions(const map::Network& network);
  void addEdge(const map::Network& network, std::size_t index);
  void addPieces(const map::Roadway& roadway, std::size_t index, std::vector<double> cuts);
  std::vector<double> addChambers(const map::Network& network, std::size_t index);
  void addQueues(std::size_t index);
  std::size_t addSection(LockSection section);
  void findIntervals(const map::Network& network);
  std::vector<DrivenEdge> driven(const map::RouteLine& route) const;
  std::size_t depot(std::size_t node) const;
  std::size_t startNode(const DrivenEdge& e) const;
  std::size_t endNode(const DrivenEdge& e) const;
  double drive(Way& way, const DrivenEdge& e, double at) const;
  double cross(Way& way, const DrivenEdge& in, const DrivenEdge& out, double at) const;

  LockMapRules rules_;
  map::RoadGraph graph_;
  std::vector<map::LockInterval> intervals_;
  std::shared_ptr<LockSite> site_ = std::make_shared<LockSite>();
  std::vector<Edge> edges_;
  std::vector<std::size_t> node_section_;  // of each junction
  std::vector<std::size_t> node_depot_;    // of each other node
};

}  // namespace pos::interval
