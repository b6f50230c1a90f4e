#pragma once
/// Mine plans in ASCII DXF (Autodesk's drawing interchange format, R12 to current): what can be used of them
/// as plain shapes, and a count of everything that cannot.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pos::io {

/// Coordinates are in drawing units.
struct DxfVertex {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double bulge = 0.0;  ///< tan(swept angle / 4) on the way to the next vertex, counter-clockwise positive
};

struct DxfEntity {
  /// Path: LINE, ARC, LWPOLYLINE, POLYLINE. Symbol: where a block is inserted.
  enum class Kind { Path, Point, Circle, Text, Symbol };
  Kind kind = Kind::Path;
  std::string type = {};                 ///< as in the file, "LWPOLYLINE"
  std::string layer = {};                ///< parts of a block on layer 0 have the layer they are inserted on
  int line = 0;                          ///< in the file
  std::vector<DxfVertex> vertices = {};  ///< Path: two or more; otherwise the one place
  bool closed = false;
  double radius = 0.0;      ///< of a circle
  std::string text = {};    ///< of a text; of a symbol its attributes, separated by blanks. UTF-8
  std::string block = {};   ///< name of the block that a symbol shows
  bool block_part = false;  ///< drawn by way of a block; the block's Symbol is listed too
};

/// Why entities of one type on one layer were left out.
struct DxfSkipped {
  std::string layer = {};
  std::string type = {};
  std::string reason = {};
  std::size_t count = 0;
  int first_line = 0;
};

struct DxfDrawing {
  std::string file = {};
  std::string version = {};                    ///< $ACADVER, "AC1009"
  std::optional<double> metres_per_unit = {};  ///< nothing where the drawing does not say
  std::vector<DxfEntity> entities = {};        ///< in file order, blocks expanded where they are inserted
  std::vector<DxfSkipped> skipped = {};
  bool complete = true;  ///< false: the file ends without EOF
};

/// Throws DataError for text that is no DXF, for binary DXF, for blocks that multiply to more than
/// 200 000 points. Damaged entities are counted as skipped.
DxfDrawing parseDxf(std::string_view text, const std::string& file);
/// Throws ConfigError for a file that is not there, DataError as above.
DxfDrawing loadDxf(const std::filesystem::path& file);

}  // namespace pos::io
