#include "pos/report/svg.hpp"

#include <cstdint>

#include "pos/report/png.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + fixed(value, 1) + "\"";
}

std::string pointList(const std::vector<Pixel>& points) {
  std::string list;
  for (const Pixel& p : points) list += fixed(p.x, 1) + "," + fixed(p.y, 1) + " ";
  if (!list.empty()) list.pop_back();
  return list;
}

/// A short name that depends on the drawing's title alone (FNV-1a).
std::string idFrom(std::string_view title) {
  std::uint32_t hash = 2166136261U;
  for (const char c : title) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return "c" + std::to_string(hash);
}

}  // namespace

std::string_view svgStyle() {
  return R"(<style>
svg.pos{font:13px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif;
--paper:#fff;--ink:#1c2530;--muted:#5b6876;--grid:#e3e7ec;--frame:#8b97a4;
--c0:#0072b2;--c1:#d55e00;--c2:#008f68;--c3:#b8558f;--c4:#b07a00;--c5:#3d9bd6}
@media(prefers-color-scheme:dark){svg.pos{--paper:#161b22;--ink:#e6edf3;--muted:#9aa7b4;--grid:#2b333d;--frame:#66727f;
--c0:#4ea8de;--c1:#f08a4b;--c2:#3cc79a;--c3:#e391c1;--c4:#e0b040;--c5:#9ad1f5}}
.pos .paper{fill:var(--paper)}.pos text{fill:var(--ink)}.pos .muted{fill:var(--muted)}
.pos .title{font-size:16px;font-weight:600}.pos .small{font-size:12px}.pos .strong{font-weight:600}
.pos .middle{text-anchor:middle}.pos .end{text-anchor:end}
.pos .halo{paint-order:stroke;stroke:var(--paper);stroke-width:4px;stroke-linejoin:round}
.pos .grid{stroke:var(--grid);stroke-width:1}.pos .frame{stroke:var(--frame);stroke-width:1;fill:none}
.pos .zero{stroke:var(--frame);stroke-width:1}
.pos .curve,.pos polyline{fill:none;stroke-width:1.5;stroke-linejoin:round}
.pos .thin{stroke-width:1}.pos .pale{stroke-opacity:.75}.pos .thick{stroke-width:3;stroke-linecap:round}.pos .dash{stroke-dasharray:5 4}
.pos .truth{stroke:var(--muted);stroke-opacity:.4;stroke-width:7;fill:none;stroke-linecap:round}
.pos .inkline{stroke:var(--ink);stroke-width:2}.pos .inkfill{fill:var(--ink)}
.pos .band{fill:var(--muted);fill-opacity:.2}.pos .anchor{fill:var(--paper);stroke:var(--ink);stroke-width:2}
.pos .bar{stroke:var(--paper);stroke-width:1}.pos .box{fill:var(--paper);fill-opacity:.55;stroke-width:1.5}
.pos .s0{stroke:var(--c0)}.pos .s1{stroke:var(--c1)}.pos .s2{stroke:var(--c2)}.pos .s3{stroke:var(--c3)}
.pos .s4{stroke:var(--c4)}.pos .s5{stroke:var(--c5)}
.pos .f0{fill:var(--c0)}.pos .f1{fill:var(--c1)}.pos .f2{fill:var(--c2)}.pos .f3{fill:var(--c3)}
.pos .f4{fill:var(--c4)}.pos .f5{fill:var(--c5)}.pos .fm{fill:var(--frame)}.pos .fg{fill:var(--grid)}
.pos .faint{fill-opacity:.45}.pos .lock{fill-opacity:.22;stroke-width:1;stroke-opacity:.55}.pos .vehicle{stroke:var(--ink);stroke-width:1.1}.pos .bracket{stroke-width:2;stroke-opacity:1}
.pos .d1{stroke-dasharray:7 3}.pos .d2{stroke-dasharray:2 3}
</style>
)";
}

std::string strokeClass(std::size_t index) {
  const std::size_t round = index / kSeriesColours;
  const std::string colour = "s" + std::to_string(index % kSeriesColours);
  return round == 0 ? colour : colour + (round % 2 == 1 ? " d1" : " d2");
}

std::string fillClass(std::size_t index) {
  return "f" + std::to_string(index % kSeriesColours);
}

Svg::Svg(double width, double height, std::string_view title, std::string_view description)
    : id_(idFrom(title)) {
  const std::string size = fixed(width, 0) + " " + fixed(height, 0);
  body_ = "<svg class=\"pos\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 " + size +
          "\" width=\"" + fixed(width, 0) + "\" height=\"" + fixed(height, 0) + "\">\n";
  body_ += "<title>" + escaped(title) + "</title><desc>" + escaped(description) + "</desc>\n";
  body_ += svgStyle();
  rect({0.0, 0.0, width, height}, "paper");
}

void Svg::line(Pixel a, Pixel b, std::string_view classes) {
  body_ += "<line" + attribute("x1", a.x) + attribute("y1", a.y) + attribute("x2", b.x) +
           attribute("y2", b.y) + " class=\"" + escaped(classes) + "\"/>\n";
}

void Svg::rect(const Box& box, std::string_view classes) {
  body_ += "<rect" + attribute("x", box.left) + attribute("y", box.top) + attribute("width", box.width) +
           attribute("height", box.height) + " class=\"" + escaped(classes) + "\"/>\n";
}

void Svg::circle(Pixel centre, double radius, std::string_view classes) {
  body_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius) +
           " class=\"" + escaped(classes) + "\"/>\n";
}

void Svg::polyline(const std::vector<Pixel>& points, std::string_view classes) {
  if (points.size() == 1) circle(points.front(), 2.5, std::string(classes) + " curve");
  if (points.size() < 2) return;
  body_ += "<polyline points=\"" + pointList(points) + "\" class=\"" + escaped(classes) + "\"/>\n";
}

void Svg::polygon(const std::vector<Pixel>& points, std::string_view classes) {
  body_ += "<polygon points=\"" + pointList(points) + "\" class=\"" + escaped(classes) + "\"/>\n";
}

void Svg::colouredLine(const std::vector<Pixel>& points, std::string_view colour) {
  if (points.empty()) return;
  const std::string dot = points.size() == 1 ? " " + pointList(points) : "";  // round caps make it visible
  body_ += "<polyline points=\"" + pointList(points) + dot + "\" class=\"thick\" stroke=\"" +
           escaped(colour) + "\"/>\n";
}

void Svg::colouredRect(const Box& box, std::string_view colour) {
  body_ += "<rect" + attribute("x", box.left) + attribute("y", box.top) + attribute("width", box.width) +
           attribute("height", box.height) + " fill=\"" + escaped(colour) + "\"/>\n";
}

void Svg::text(Pixel at, std::string_view text, std::string_view classes) {
  body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + " class=\"" + escaped(classes) + "\">" +
           escaped(text) + "</text>\n";
}

void Svg::uprightText(Pixel at, std::string_view text, std::string_view classes) {
  body_ += "<text transform=\"translate(" + fixed(at.x, 1) + " " + fixed(at.y, 1) +
           ") rotate(-90)\" class=\"" + escaped(classes) + "\">" + escaped(text) + "</text>\n";
}

void Svg::image(const std::string& png, int columns, int rows, Pixel origin, Pixel along_u, Pixel along_v) {
  std::string matrix;
  for (const double m : {along_u.x, along_u.y, along_v.x, along_v.y, origin.x, origin.y}) {
    matrix += fixed(m, 6) + " ";
  }
  matrix.pop_back();
  body_ += "<image width=\"" + std::to_string(columns) + "\" height=\"" + std::to_string(rows) +
           "\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" transform=\"matrix(" +
           matrix + ")\" href=\"data:image/png;base64," + base64(png) + "\"/>\n";
}

void Svg::beginClip(const Box& box) {
  const std::string id = id_ + "_" + std::to_string(clips_++);
  body_ += "<clipPath id=\"" + id + "\"><rect" + attribute("x", box.left) + attribute("y", box.top) +
           attribute("width", box.width) + attribute("height", box.height) +
           "/></clipPath><g clip-path=\"url(#" + id + ")\">\n";
}

void Svg::endClip() {
  body_ += "</g>\n";
}

}  // namespace pos::report
