#include "pos/io/map_tables.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "map_assembly.hpp"
#include "map_options.hpp"
#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/import_mapping.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using map::MineGrid;

OptionTable<ColumnSource> sourceOptions(Quantity quantity) {
  return OptionTable<ColumnSource>("source", "Where a number comes from.")
      .text("column", &ColumnSource::column, "Name of the column.")
      .number("value", &ColumnSource::value, anything(), "One value for all rows, instead of a column.")
      .text("unit", &ColumnSource::unit,
            "Unit of the column or value: " + text::joined(unitsOf(quantity)) + ".")
      .required()
      .check([quantity](const ColumnSource& source) {
        if (source.column.empty() == !source.value) {
          throw ConfigError(
              Complaint{.what = "a field needs either a column or a value",
                        .key = "column",
                        .expected = "{column: <name>, unit: <unit>} or {value: <number>, unit: <unit>}"});
        }
        if (unitFactor(quantity, source.unit)) return;
        throw ConfigError(Complaint{.what = "the unit does not fit the field",
                                    .key = "unit",
                                    .got = source.unit,
                                    .expected = "one of " + text::joined(unitsOf(quantity))});
      });
}

OptionTable<StationTable> stationOptions() {
  const auto length = sourceOptions(Quantity::Length);
  const auto angle = sourceOptions(Quantity::Angle);
  return OptionTable<StationTable>("stations", "Surveyed points along the roadways, in order.")
      .text("file", &StationTable::file, "The table, in the data folder.")
      .required()
      .text("roadway", &StationTable::roadway, "Column with the id of the roadway.")
      .required()
      .table("x", &StationTable::x, length, "East.")
      .required()
      .table("y", &StationTable::y, length, "North.")
      .required()
      .table("z", &StationTable::z, length, "Height of the floor.")
      .required()
      .table("station", &StationTable::station, length, "Chainage as surveyed.")
      .table("arc", &StationTable::arc, angle, "Angle swept on the way to the next point, left positive.")
      .table("width", &StationTable::width, length, "Width between the walls; a roadway's first row counts.")
      .table("height", &StationTable::height, length, "Height of the roof; a roadway's first row counts.");
}

OptionTable<AnchorTable> anchorTableOptions() {
  const auto length = sourceOptions(Quantity::Length);
  return OptionTable<AnchorTable>("anchors", "The radio anchors.")
      .text("file", &AnchorTable::file, "The table, in the data folder.")
      .required()
      .text("id", &AnchorTable::id, "Column with the radio's own number.")
      .required()
      .text("name", &AnchorTable::name, "Column with the name on drawings.")
      .table("x", &AnchorTable::x, length, "East.")
      .required()
      .table("y", &AnchorTable::y, length, "North.")
      .required()
      .table("z", &AnchorTable::z, length, "Height.")
      .required()
      .table("survey_sigma", &AnchorTable::survey_sigma, length, "Standard deviation of each axis.")
      .table("range_bias", &AnchorTable::range_bias, length, "Subtracted from every range.")
      .text("survey_date", &AnchorTable::survey_date, "Column with the day of the survey, YYYY-MM-DD.");
}

OptionTable<TableMapImport> mappingOptions() {
  return OptionTable<TableMapImport>("Map import", "A map from a surveyor's tables.")
      .text("name", &TableMapImport::name, "Name of the map.")
      .required()
      .table("mine_grid", &TableMapImport::mine_grid, mineGridOptions(),
             "The grid of the tables' coordinates, and the map's origin in it.")
      .number("junction_reach_m", &TableMapImport::junction_reach, between(0, 100),
              "A roadway that ends this near another one joins it.")
      .table("stations", &TableMapImport::stations, stationOptions(), "Surveyed points along the roadways.")
      .table("anchors", &TableMapImport::anchors, anchorTableOptions(), "The radio anchors.")
      .check([](const TableMapImport& mapping) {
        if (mapping.stations || mapping.anchors) return;
        throw ConfigError(
            Complaint{.what = "the mapping names no table", .expected = "stations, anchors or both"});
      });
}

/// One number of the current row, SI.
class Cell {
 public:
  Cell(const CsvReader& csv, const ColumnSource& source, Quantity quantity)
      : csv_(csv),
        factor_(unitFactor(quantity, source.unit).value_or(1.0)),
        value_(source.value.value_or(0.0)) {
    if (!source.value) column_ = csv.column(source.column);
  }
  double operator()() const { return factor_ * (column_ ? csv_.number(*column_) : value_); }
  bool empty() const { return column_ && csv_.cell(*column_).empty(); }

 private:
  const CsvReader& csv_;
  double factor_;
  double value_;
  std::optional<std::size_t> column_;
};

class OptionalCell {
 public:
  OptionalCell(const CsvReader& csv, const std::optional<ColumnSource>& source, Quantity quantity) {
    if (source) cell_.emplace(csv, *source, quantity);
  }
  /// Nothing where there is no such column or the cell is empty.
  std::optional<double> operator()() const {
    return cell_ && !cell_->empty() ? std::optional((*cell_)()) : std::nullopt;
  }

 private:
  std::optional<Cell> cell_;
};

/// x, y, z of the current row in the map frame.
class PointCells {
 public:
  template <class Table>
  PointCells(const CsvReader& csv, const Table& table, const std::optional<MineGrid>& grid)
      : x_(csv, table.x, Quantity::Length),
        y_(csv, table.y, Quantity::Length),
        z_(csv, table.z, Quantity::Length),
        grid_(grid) {}
  Eigen::Vector3d operator()() const {
    const Eigen::Vector3d p(x_(), y_(), z_());
    return grid_ ? map::fromGrid(*grid_, p) : p;
  }

 private:
  Cell x_, y_, z_;
  const std::optional<MineGrid>& grid_;
};

/// The roadway of this id; a new one at its first row.
map::Roadway& roadwayOf(std::vector<map::Roadway>& roadways, const std::string& id) {
  const auto found =
      std::find_if(roadways.begin(), roadways.end(), [&](const map::Roadway& r) { return r.id == id; });
  if (found != roadways.end()) return *found;
  roadways.emplace_back().id = id;
  return roadways.back();
}

/// Where the objects of the map stand in the tables: "roadways[0].centreline[3]" -> stations.csv, line 5.
using Rows = std::map<std::string, FilePlace>;

/// The complaint about the map with the row that it is about.
Complaint placed(Complaint complaint, const Rows& rows) {
  for (std::string key = complaint.key; !key.empty();) {
    const auto row = rows.find(key);
    if (row != rows.end()) {
      complaint.place = row->second;
      break;
    }
    const std::size_t parent = key.rfind('.');
    key.resize(parent == std::string::npos ? 0 : parent);
  }
  return complaint;
}

std::string indexed(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

struct Stations {
  std::vector<map::Roadway> roadways;
  std::size_t rows = 0;
};

Stations stationsOf(const TableMapImport& mapping, const std::filesystem::path& folder, Rows& rows) {
  const StationTable& table = *mapping.stations;
  CsvReader csv(folder / table.file);
  const std::size_t id_column = csv.column(table.roadway);
  const PointCells point(csv, table, mapping.mine_grid);
  const OptionalCell station(csv, table.station, Quantity::Length);
  const OptionalCell arc(csv, table.arc, Quantity::Angle);
  const OptionalCell width(csv, table.width, Quantity::Length);
  const OptionalCell height(csv, table.height, Quantity::Length);
  Stations read;
  for (; csv.next(); ++read.rows) {
    const std::string id(csv.cell(id_column));
    if (id.empty()) csv.refuse(id_column, "a station without roadway", "the id of its roadway");
    map::Roadway& roadway = roadwayOf(read.roadways, id);
    const std::string key = indexed("roadways", static_cast<std::size_t>(&roadway - read.roadways.data()));
    rows[indexed(key + ".centreline", roadway.centreline.size())] = csv.place(id_column);
    if (roadway.centreline.empty()) {
      rows[key] = csv.place(id_column);
      roadway.width = width().value_or(roadway.width);
      roadway.height = height().value_or(roadway.height);
      roadway.chainage_start = station().value_or(0.0);
    }
    roadway.centreline.push_back({.p_map = point(), .arc = arc().value_or(0.0), .station = station()});
  }
  return read;
}

std::vector<map::Anchor> anchorsOf(const TableMapImport& mapping, const std::filesystem::path& folder,
                                   Rows& rows) {
  std::vector<map::Anchor> anchors;
  const AnchorTable& table = *mapping.anchors;
  CsvReader csv(folder / table.file);
  const std::size_t id_column = csv.column(table.id);
  const PointCells point(csv, table, mapping.mine_grid);
  const OptionalCell sigma(csv, table.survey_sigma, Quantity::Length);
  const OptionalCell bias(csv, table.range_bias, Quantity::Length);
  const auto textOf = [&csv](const std::optional<std::string>& column) {
    return column ? std::string(csv.cell(csv.column(*column))) : std::string();
  };
  while (csv.next()) {
    const std::int64_t id = csv.integer(id_column);
    if (id < std::numeric_limits<AnchorId>::min() || id > std::numeric_limits<AnchorId>::max())
      csv.refuse(id_column, "the number is too large for an id", "a 32-bit integer");
    rows[indexed("anchors", anchors.size())] = csv.place(id_column);
    map::Anchor anchor;
    anchor.id = static_cast<AnchorId>(id);
    anchor.name = textOf(table.name);
    if (anchor.name.empty()) anchor.name = std::to_string(id);
    anchor.p_map = point();
    anchor.survey_sigma = sigma().value_or(0.0);
    anchor.range_bias = bias().value_or(0.0);
    anchor.survey_date = textOf(table.survey_date);
    anchors.push_back(std::move(anchor));
  }
  return anchors;
}

std::vector<Eigen::Vector3d> pointsOf(const map::TunnelMap& map) {
  std::vector<Eigen::Vector3d> points;
  for (const map::Roadway& roadway : map.roadways) {
    for (const map::CentrelinePoint& point : roadway.centreline) points.push_back(point.p_map);
  }
  for (const map::Anchor& anchor : map.anchors) points.push_back(anchor.p_map);
  return points;
}

}  // namespace

TableMapImport parseTableMapping(const std::string& text, const std::filesystem::path& file) {
  return readOptions(parseYaml(text, file), mappingOptions());
}

TableMapImport readTableMapping(const std::filesystem::path& file) {
  return readOptions(loadYaml(file), mappingOptions());
}

TableMap mapFromTables(const TableMapImport& mapping, const std::filesystem::path& data_dir) {
  TableMap result;
  Rows rows;
  result.map.name = mapping.name;
  result.map.mine_grid = mapping.mine_grid;
  if (mapping.stations) {
    Stations stations = stationsOf(mapping, data_dir, rows);
    result.map.roadways = std::move(stations.roadways);
    result.stations = stations.rows;
  }
  if (mapping.anchors) result.map.anchors = anchorsOf(mapping, data_dir, rows);
  requireLocal(pointsOf(result.map), mapping.stations ? mapping.stations->file : mapping.anchors->file);
  try {
    (void)checkedMapText({.map = result.map, .grid = {}});
  } catch (const ConfigError& error) {
    throw ConfigError(placed(error.complaint(), rows));
  }
  result.map.junctions = junctionsFound(result.map.roadways, mapping.junction_reach);
  return result;
}

}  // namespace pos::io
