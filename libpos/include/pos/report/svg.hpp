#pragma once
/// A small writer of SVG drawings. Looks come from classes (see svgStyle), so that one drawing reads well on
/// light and on dark paper, inside the report and as a file of its own.

#include <string>
#include <string_view>
#include <vector>

namespace pos::report {

/// Pixel coordinates, y down.
struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

/// Number of series colours (Okabe and Ito's colour-blind safe set); series i uses classes s<i> and f<i>.
inline constexpr int kSeriesColours = 6;

/// The style sheet that every drawing carries.
std::string_view svgStyle();
/// "s2 d1": stroke colour of series `index`; from the seventh on the colours repeat with dashes.
std::string strokeClass(std::size_t index);
/// "f2".
std::string fillClass(std::size_t index);

class Svg {
 public:
  /// `title` and `description` are read by screen readers.
  Svg(double width, double height, std::string_view title, std::string_view description);

  void line(Pixel a, Pixel b, std::string_view classes);
  void rect(const Box& box, std::string_view classes);
  void circle(Pixel centre, double radius, std::string_view classes);
  /// A single point becomes a small ring.
  void polyline(const std::vector<Pixel>& points, std::string_view classes);
  void polygon(const std::vector<Pixel>& points, std::string_view classes);
  /// A broad line in a colour given as "#rrggbb"; a single point becomes a dot.
  void colouredLine(const std::vector<Pixel>& points, std::string_view colour);
  void colouredRect(const Box& box, std::string_view colour);
  /// Text is escaped here. Classes: "start", "middle" or "end" for the anchor, "title", "small", "muted".
  void text(Pixel at, std::string_view text, std::string_view classes = "start");
  /// Text turned a quarter to the left, centred on `at`.
  void uprightText(Pixel at, std::string_view text, std::string_view classes = "middle");
  /// A PNG (bytes) whose pixel (u, v) lands on origin + u * along_u + v * along_v.
  void image(const std::string& png, int columns, int rows, Pixel origin, Pixel along_u, Pixel along_v);
  /// Everything until endClip() is cut to the box.
  void beginClip(const Box& box);
  void endClip();

  /// The finished drawing.
  std::string str() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
  std::string id_;  ///< of this drawing, so that ids stay unique when several share a page
  int clips_ = 0;
};

}  // namespace pos::report
