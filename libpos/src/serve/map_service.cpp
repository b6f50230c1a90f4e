#include "pos/serve/map_service.hpp"

#include <cmath>
#include <memory>

#include "json_parts.hpp"
#include "pos/io/append_file.hpp"
#include "pos/io/files.hpp"
#include "pos/io/map_diff.hpp"
#include "pos/io/map_geojson.hpp"
#include "pos/io/sha256.hpp"
#include "pos/map/checks.hpp"
#include "pos/map/coverage.hpp"
#include "pos/map/lock_intervals.hpp"
#include "pos/serve/state.hpp"

namespace pos::serve {
namespace {

namespace fs = std::filesystem;

constexpr double kMostSamples = 200'000;

/// What `work` gives; a complaint about the map becomes an answer.
template <class Work>
auto judged(Work&& work) {
  try {
    return work();
  } catch (const ConfigError& error) {
    throw RequestError(422, "invalid_map", error.complaint());
  }
}

io::GeoJsonImport importOf(const std::string& body) {
  return judged([&] { return io::parsedGeoJson(body, "map.geojson"); });
}

map::Network networkOf(const map::TunnelMap& tunnel_map) {
  return map::Network(std::make_shared<const map::TunnelMap>(tunnel_map));
}

std::string versionOf(const std::string& bytes) {
  return "\"" + io::sha256(bytes) + "\"";
}

Json findingJson(const map::Finding& finding) {
  return {{"severity", map::name(finding.severity)},
          {"check", map::name(finding.check)},
          {"what", finding.what},
          {"remedy", finding.remedy},
          {"objects", finding.objects},
          {"place",
           {{"x_m", number(finding.p_map.x())},
            {"y_m", number(finding.p_map.y())},
            {"z_m", number(finding.p_map.z())}}}};
}

map::CoverageRules rulesOf(const Target& target, const map::TunnelMap& tunnel_map) {
  const map::Requirements site = tunnel_map.requirements.value_or(map::Requirements{});
  return {.range_sigma = numberOf(target, "range_sigma_m", 1e-3, 100).value_or(0.1),
          .range_limit = numberOf(target, "range_limit_m", 1, 1e5).value_or(site.range_limit),
          .tag_height = numberOf(target, "tag_height_m", 0, 20).value_or(site.tag_height),
          .step = numberOf(target, "step_m", 0.1, 1e4).value_or(1.0)};
}

void requireFewSamples(const map::Network& network, double step) {
  double length = 0.0;
  for (map::RoadwayIndex r = 0; r < network.map().roadways.size(); ++r)
    length += network.centreline(r).length();
  if (length / step <= kMostSamples) return;
  throw badRequest(Complaint{.what = "the step is too small for roadways this long",
                             .key = "step_m",
                             .expected = "at most 200,000 samples"});
}

Json stripJson(const map::Network& network, map::RoadwayIndex roadway, const map::CoverageRules& rules) {
  Json strip{{"roadway", network.map().roadways[roadway].id},
             {"chainage_m", Json::array()},
             {"anchors", Json::array()},
             {"along_m", Json::array()},
             {"across_m", Json::array()}};
  for (const map::CoverageSample& sample : map::coverage(network, roadway, rules)) {
    strip["chainage_m"].push_back(number(sample.point.chainage));
    strip["anchors"].push_back(sample.anchors);
    strip["along_m"].push_back(number(sample.along));
    strip["across_m"].push_back(number(sample.across));
  }
  return strip;
}

const char* kindName(io::MapChange::Kind kind) {
  return kind == io::MapChange::Kind::Added     ? "added"
         : kind == io::MapChange::Kind::Removed ? "removed"
                                                : "changed";
}

/// A new file beside the old one, then a rename: whoever reads sees one of them, whole.
void replace(const fs::path& file, const std::string& text) {
  const fs::path draft = file.parent_path() / ("." + file.filename().string() + ".draft");
  std::error_code failed;
  fs::remove(draft, failed);
  io::AppendFile writer(draft);
  writer.append(text);
  writer.close();
  fs::permissions(draft, fs::status(file).permissions(), failed);
  fs::rename(draft, file);
}

}  // namespace

MapService::Version MapService::saved() const {
  const std::string bytes = io::fileText(file_);
  return {io::mapGeoJson(judged([&] { return io::parsedMap(bytes, file_.filename()); })), versionOf(bytes)};
}

std::string MapService::check(const std::string& body) const {
  const io::GeoJsonImport import = importOf(body);
  const auto findings = judged([&] { return map::findings(networkOf(import.file.map), {}); });
  Json list = Json::array();
  for (const map::Finding& finding : findings) list.push_back(findingJson(finding));
  return textOf({{"findings", list}, {"remarks", import.remarks}});
}

std::string MapService::coverage(const std::string& body, const Target& target) const {
  requireOnly(target, {"roadway", "step_m", "range_sigma_m", "range_limit_m", "tag_height_m"});
  const io::GeoJsonImport import = importOf(body);
  return judged([&] {
    const map::Network network = networkOf(import.file.map);
    const map::CoverageRules rules = map::validated(rulesOf(target, network.map()));
    requireFewSamples(network, rules.step);
    Json strips = Json::array();
    const auto wanted = target.query.find("roadway");
    if (wanted != target.query.end()) {
      strips.push_back(stripJson(network, network.indexOf(wanted->second), rules));
    } else {
      for (map::RoadwayIndex r = 0; r < network.map().roadways.size(); ++r)
        strips.push_back(stripJson(network, r, rules));
    }
    return textOf({{"roadways", strips}});
  });
}

std::string MapService::diff(const std::string& body) const {
  const io::GeoJsonImport import = importOf(body);
  const auto saved = judged([&] { return io::readMapFile(file_); });
  Json list = Json::array();
  for (const io::MapChange& change : io::mapChanges(saved, import.file)) {
    list.push_back({{"kind", kindName(change.kind)},
                    {"object", change.object},
                    {"key", change.key},
                    {"before", change.before},
                    {"after", change.after},
                    {"words", change.words}});
  }
  return textOf({{"changes", list}});
}

std::string MapService::intervals(const std::string& body) const {
  const io::GeoJsonImport import = importOf(body);
  return judged([&] {
    const map::Network network = networkOf(import.file.map);
    Names names;
    for (const map::Roadway& roadway : network.map().roadways) names.roadways.push_back(roadway.id);
    if (!names.roadways.empty()) names.intervals = map::divided(map::RoadGraph(network), network, {});
    return intervalsJson(names);
  });
}

std::string MapService::save(const std::string& body, const std::string& if_match) {
  if (!editable()) {
    throw RequestError(403, "read_only",
                       Complaint{.what = "the map may not be changed",
                                 .suggestion = "start pos serve with --map and the file to be edited"});
  }
  if (if_match.empty()) {
    throw RequestError(428, "version_missing",
                       Complaint{.what = "the request does not say which version it changes",
                                 .key = "If-Match",
                                 .expected = "the ETag of GET /api/map"});
  }
  const io::GeoJsonImport import = importOf(body);
  const std::string text = judged([&] { return io::checkedMapText(import.file); });
  const std::lock_guard lock(mutex_);
  const std::string now = versionOf(io::fileText(file_));
  if (now != if_match) {
    throw RequestError(412, "conflict",
                       Complaint{.what = "the map was saved by somebody else in the meantime",
                                 .key = "If-Match",
                                 .got = if_match,
                                 .expected = now,
                                 .suggestion = "load the map again and repeat the changes"});
  }
  replace(file_, text);
  return versionOf(text);
}

}  // namespace pos::serve
