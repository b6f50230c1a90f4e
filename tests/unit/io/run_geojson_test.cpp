/// Tracks of a run folder as GeoJSON.
#include "pos/io/run_geojson.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/io/trajectory_io.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

Estimate at(double seconds, double x, double y) {
  Estimate estimate;
  estimate.stamp = stampFromSeconds(seconds);
  estimate.T_map_body.translation = {x, y, -2.5};
  return estimate;
}

void writeTrack(const ScratchFolder& folder, const std::string& name, const std::vector<Estimate>& track) {
  TumWriter tum(folder.path() / (name + ".tum"));
  EstimateCsvWriter csv(folder.path() / (name + ".csv"));
  for (const Estimate& estimate : track) {
    tum.write(estimate);
    csv.write(estimate, {});
  }
  tum.close();
  csv.close();
}

TEST(RunGeoJson, TracksAreLinesInMetresWithTheirStamps) {
  const ScratchFolder folder;
  writeTrack(folder, "ekf", {at(10.0, 1.0, 2.0), at(10.5, 1.25, 2.0)});
  writeTrack(folder, "one", {at(11.0, 3.0, 4.0)});
  writeTrack(folder, "silent", {});
  TrackOptions options;
  options.truth.emplace();
  options.truth->poses = {{stampFromSeconds(10.0), Pose3::fromPlanar({1.0, 2.0, 0.0})},
                          {stampFromSeconds(12.0), Pose3::fromPlanar({2.0, 2.0, 0.0})}};
  EXPECT_EQ(writeRunGeoJson(folder.path(), folder.path() / "a.geojson", options), 5U);
  EXPECT_EQ(
      folder.read("a.geojson"),
      "{\"type\": \"FeatureCollection\", \"features\": [\n"
      "{\"type\": \"Feature\", \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[1.000, 2.000, "
      "-2.500], "
      "[1.250, 2.000, -2.500]]}, \"properties\": {\"object\": \"track\", \"name\": \"ekf\", \"kind\": "
      "\"estimate\", "
      "\"stamps_s\": [10.000000000, 10.500000000]}},\n"
      "{\"type\": \"Feature\", \"geometry\": {\"type\": \"Point\", \"coordinates\": [3.000, 4.000, -2.500]}, "
      "\"properties\": {\"object\": \"track\", \"name\": \"one\", \"kind\": \"estimate\", \"stamps_s\": "
      "[11.000000000]}},\n"
      "{\"type\": \"Feature\", \"geometry\": null, \"properties\": {\"object\": \"track\", \"name\": "
      "\"silent\", "
      "\"kind\": \"estimate\", \"stamps_s\": []}},\n"
      "{\"type\": \"Feature\", \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[1.000, 2.000, "
      "0.000], "
      "[2.000, 2.000, 0.000]]}, \"properties\": {\"object\": \"track\", \"name\": \"truth\", \"kind\": "
      "\"truth\", "
      "\"stamps_s\": [10.000000000, 12.000000000]}}\n]}\n");
}

TEST(RunGeoJson, DegreesComeFromTheMapsOrigin) {
  const ScratchFolder folder;
  writeTrack(folder, "ekf", {at(10.0, 0.0, 0.0), at(10.5, 0.0, 100.0)});
  TrackOptions options;
  options.origin =
      map::GeodeticOrigin{.latitude = radians(50.0), .longitude = radians(7.0), .altitude = 100.0};
  writeRunGeoJson(folder.path(), folder.path() / "a.geojson", options);
  const std::string text = folder.read("a.geojson");
  EXPECT_NE(text.find("[7.000000000, 50.000000000, 97.500]"), std::string::npos) << text;
  // 100 m to the north are 100 / 6 373 km (the radius of curvature of the meridian there) of a radian.
  EXPECT_NE(text.find("[7.000000000, 50.00089"), std::string::npos) << text;
}

TEST(RunGeoJson, AFolderWithoutARunIsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(writeRunGeoJson(folder.path(), folder.path() / "a.geojson", {}), DataError);
}

}  // namespace
}  // namespace pos::io
