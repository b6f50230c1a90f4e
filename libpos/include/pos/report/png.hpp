#pragma once
/// A map's occupancy grid as a small picture.

#include <cstdint>
#include <string>
#include <vector>

#include "pos/map/tunnel_map.hpp"

namespace pos::report {

/// A picture of four colours, row by row from the top, values 0..3.
struct Picture {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;
};

/// Free space 0, uncertain 1, rock 2, never seen 3; the first row is the grid's highest. `step` cells become
/// one pixel, chosen so that neither side exceeds `most_pixels`; rock wins inside a pixel.
struct GridPicture {
  Picture picture;
  int step = 1;
};
GridPicture gridPicture(const map::OccupancyGrid& grid, int most_pixels = 1000);

/// PNG file (W3C PNG second edition) with a 2-bit palette: free transparent, uncertain and never seen faint,
/// rock grey, so that it suits light and dark paper. Stored without compression.
std::string pngBytes(const Picture& picture);

/// RFC 4648.
std::string base64(const std::string& bytes);

}  // namespace pos::report
