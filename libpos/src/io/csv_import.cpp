#include "pos/io/csv_import.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "import_table.hpp"
#include "pos/io/range_faults.hpp"

namespace pos::io {
namespace {

struct StreamPart {
  std::vector<Measurement> measurements;
  TableCount count;
};

StreamPart readStream(const TableMapping& mapping, const std::filesystem::path& data_dir, Stamp origin,
                      const TagPlaces& tags) {
  ImportTable table(mapping, data_dir, origin);
  const auto row = rowReader(table, tags);
  StreamPart part;
  part.count = forEachRow(table, [&] {
    Measurement measurement{table.stamp(), mapping.sensor, row()};
    if (const auto what = defect(measurement)) {
      throw DataError(Complaint{
          .what = *what,
          .place = {.file = table.csv().file(), .line = table.csv().line()},
          .suggestion = "repair the row, or write `bad_rows: skip` to leave out such rows and count them"});
    }
    part.measurements.push_back(std::move(measurement));
  });
  return part;
}

struct TruthPart {
  Truth truth;
  TableCount count;
};

TruthPart readTruth(const TableMapping& mapping, const std::filesystem::path& data_dir, Stamp origin) {
  ImportTable table(mapping, data_dir, origin);
  const auto row = truthReader(table);
  TruthPart part;
  part.truth.has_z = table.findField("z").has_value();
  part.truth.has_yaw = table.findField("yaw").has_value() || table.findField("qw").has_value();
  part.count = forEachRow(table, [&] {
    const TruthPose pose = row();
    if (!part.truth.poses.empty() && pose.stamp <= part.truth.poses.back().stamp) {
      table.refuse(table.field("stamp"), "the truth's stamps do not increase", text::stampSeconds(pose.stamp),
                   "a stamp after " + text::stampSeconds(part.truth.poses.back().stamp));
    }
    part.truth.poses.push_back(pose);
  });
  return part;
}

struct AnchorPart {
  std::vector<map::Anchor> anchors;
  TableCount count;
};

AnchorPart readAnchors(const TableMapping& mapping, const std::filesystem::path& data_dir) {
  ImportTable table(mapping, data_dir, Stamp{});
  AnchorPart part;
  part.count = forEachRow(
      table, [&, id = table.field("id"), x = table.field("x"), y = table.field("y"), z = table.field("z"),
              survey_sigma = table.findField("survey_sigma"), range_bias = table.findField("range_bias")] {
        map::Anchor anchor;
        anchor.id = table.id(id);
        anchor.name = std::to_string(anchor.id);
        anchor.p_map = {table.number(x), table.number(y), table.number(z)};
        anchor.survey_sigma = table.number(survey_sigma).value_or(0.0);
        anchor.range_bias = table.number(range_bias).value_or(0.0);
        part.anchors.push_back(anchor);
      });
  return part;
}

struct TagPart {
  TagPlaces tags;
  TableCount count;
};

TagPart readTags(const TableMapping& mapping, const std::filesystem::path& data_dir) {
  ImportTable table(mapping, data_dir, Stamp{});
  TagPart part;
  part.count = forEachRow(
      table, [&, id = table.field("id"), x = table.field("x"), y = table.field("y"), z = table.field("z")] {
        const TagId tag = table.id(id);
        part.tags.emplace_back(tag, Eigen::Vector3d{table.number(x), table.number(y), table.number(z)});
      });
  return part;
}

void requireUniqueTags(const TagPlaces& tags) {
  std::vector<TagId> ids;
  for (const auto& [id, p_body] : tags) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice == ids.end()) return;
  throw DataError(Complaint{.what = "two tags have the same id",
                            .key = "tags",
                            .got = "id " + std::to_string(*twice),
                            .expected = "every id once"});
}

void requireShare(double value, double low, double high, const char* key) {
  if (value >= low && value <= high) return;
  throw ConfigError(Complaint{.what = "the import option is out of range",
                              .key = key,
                              .got = text::shortest(value),
                              .expected = text::shortest(low) + " .. " + text::shortest(high)});
}

std::size_t rangesToUnknownAnchors(const ImportResult& result) {
  const auto unknown = [&](const Measurement& measurement) {
    const auto* range = std::get_if<BeaconRange>(&measurement.reading);
    return range != nullptr && result.map.findAnchor(range->anchor) == nullptr;
  };
  return static_cast<std::size_t>(
      std::count_if(result.measurements.begin(), result.measurements.end(), unknown));
}

/// Truth, map and tags of the import, with the counts of their tables.
ImportResult withoutStreams(const ImportMapping& mapping, const std::filesystem::path& data_dir) {
  ImportResult result;
  result.map.name = mapping.name;
  result.map.anchors = mapping.listed_anchors;
  result.tags = mapping.listed_tags;
  if (mapping.truth) {
    auto [truth, count] = readTruth(*mapping.truth, data_dir, mapping.origin);
    result.truth = std::move(truth);
    result.counts.tables.push_back(count);
  }
  if (mapping.anchors) {
    auto [anchors, count] = readAnchors(*mapping.anchors, data_dir);
    result.map.anchors = std::move(anchors);
    result.counts.tables.push_back(count);
  }
  if (mapping.tags) {
    auto [tags, count] = readTags(*mapping.tags, data_dir);
    result.tags = std::move(tags);
    result.counts.tables.push_back(count);
  }
  result.map = map::validated(std::move(result.map));
  requireUniqueTags(result.tags);
  return result;
}

}  // namespace

ImportOptions validated(const ImportOptions& options) {
  requireShare(options.range_outlier_probability, 0.0, 1.0, "range_outlier_probability");
  requireShare(options.range_outlier_min_m, 0.0, 1e6, "range_outlier_min_m");
  requireShare(options.range_outlier_max_m, options.range_outlier_min_m, 1e6, "range_outlier_max_m");
  return options;
}

InjectedOutliers withRangeOutliers(std::vector<Measurement> measurements, const ImportOptions& options) {
  const ImportOptions checked = validated(options);
  RangeFaults faults({.probability = checked.range_outlier_probability,
                      .min = checked.range_outlier_min_m,
                      .max = checked.range_outlier_max_m,
                      .seed = checked.seed});
  for (Measurement& measurement : measurements) measurement = faults.applied(std::move(measurement));
  return {std::move(measurements), static_cast<std::size_t>(faults.count())};
}

ImportResult importCsv(const ImportMapping& mapping, const std::filesystem::path& data_dir,
                       const ImportOptions& options) {
  const ImportOptions checked = validated(options);
  ImportResult result = withoutStreams(mapping, data_dir);
  std::vector<TableCount> stream_counts;
  for (const TableMapping& stream : mapping.streams) {
    auto [part, count] = readStream(stream, data_dir, mapping.origin, result.tags);
    std::move(part.begin(), part.end(), std::back_inserter(result.measurements));
    stream_counts.push_back(count);
  }
  auto& tables = result.counts.tables;
  tables.insert(tables.begin(), stream_counts.begin(), stream_counts.end());
  std::stable_sort(result.measurements.begin(), result.measurements.end(),
                   [](const Measurement& a, const Measurement& b) { return a.stamp < b.stamp; });
  auto [measurements, outliers] = withRangeOutliers(std::move(result.measurements), checked);
  result.measurements = std::move(measurements);
  result.counts.outliers_injected = outliers;
  result.counts.ranges_to_unknown_anchors = rangesToUnknownAnchors(result);
  return result;
}

ImportResult importCsv(const std::filesystem::path& mapping, const std::filesystem::path& data_dir,
                       const ImportOptions& options) {
  return importCsv(readImportMapping(mapping), data_dir, options);
}

}  // namespace pos::io
