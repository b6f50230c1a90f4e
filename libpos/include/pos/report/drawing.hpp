#pragma once
/// A drawing as a list of shapes in fixed colours, for plans that are printed. The same list becomes an SVG
/// or a PNG, so that the two cannot differ.

#include <string>
#include <variant>
#include <vector>

#include "pos/report/svg.hpp"

namespace pos::report {

/// "#rrggbb"; empty = not painted.
using Colour = std::string;

struct Paint {
  Colour fill = {};
  Colour stroke = {};
  double stroke_width = 1.0;      ///< px
  std::vector<double> dash = {};  ///< px drawn, px left out, ...
};

enum class TextAnchor { Start, Middle, End };

struct DrawnLine {
  std::vector<Pixel> points = {};
  Paint paint = {};
};
struct DrawnPolygon {
  std::vector<Pixel> points = {};
  Paint paint = {};
};
struct DrawnCircle {
  Pixel centre = {};
  double radius = 0.0;  ///< px
  Paint paint = {};
};
struct DrawnText {
  Pixel at = {};  ///< on the base line
  std::string text = {};
  double size = 12.0;  ///< px
  Colour colour = "#1c2530";
  TextAnchor anchor = TextAnchor::Start;
  bool bold = false;
  Colour halo = {};  ///< outline behind the letters, keeps them readable on lines
};
/// A picture file (PNG or JPEG bytes) whose pixel (u, v) lands on origin + u * along_u + v * along_v.
struct DrawnImage {
  std::string bytes = {};
  int columns = 0;
  int rows = 0;
  Pixel origin = {};
  Pixel along_u = {};
  Pixel along_v = {};
  Box clip = {};
};
using Shape = std::variant<DrawnPolygon, DrawnLine, DrawnCircle, DrawnText, DrawnImage>;

struct Drawing {
  double width = 0.0;   ///< px
  double height = 0.0;  ///< px
  std::string title = {};
  std::string description = {};
  std::vector<Shape> shapes = {};  ///< later ones cover earlier ones

  void add(Shape shape) { shapes.push_back(std::move(shape)); }
};

/// Estimated width of a text in px; the two writers use fonts of about this width.
double textWidth(const std::string& text, double size, bool bold = false);

/// The drawing as SVG on white paper. The same drawing gives the same bytes.
std::string drawingSvg(const Drawing& drawing);

/// The drawing as PNG bytes, `scale` image pixels to a drawing pixel. Letters come from OpenCV's stroke font,
/// which has ASCII only; any other character becomes '?'. Throws ConfigError when the picture would have more
/// than 2e8 pixels, DataError when a picture in it cannot be decoded.
std::string drawingPng(const Drawing& drawing, double scale = 1.0);

}  // namespace pos::report
