#include "pos/report/drawing.hpp"

#include "pos/report/png.hpp"
#include "pos/report/text.hpp"

namespace pos::report {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + escaped(value) + "\"";
}
std::string attribute(const char* name, double value) {
  return attribute(name, fixed(value, 2));
}

std::string paintText(const Paint& paint) {
  std::string text = attribute("fill", paint.fill.empty() ? "none" : paint.fill);
  if (paint.stroke.empty()) return text;
  text += attribute("stroke", paint.stroke) + attribute("stroke-width", paint.stroke_width);
  std::string dashes;
  for (const double length : paint.dash) dashes += (dashes.empty() ? "" : " ") + fixed(length, 1);
  return dashes.empty() ? text : text + attribute("stroke-dasharray", dashes);
}

std::string pointsText(const std::vector<Pixel>& points) {
  std::string list;
  for (const Pixel& p : points) list += (list.empty() ? "" : " ") + fixed(p.x, 2) + "," + fixed(p.y, 2);
  return attribute("points", list);
}

std::string anchorText(TextAnchor anchor) {
  if (anchor == TextAnchor::Start) return {};
  return attribute("text-anchor", anchor == TextAnchor::Middle ? "middle" : "end");
}

struct Writer {
  std::string body;
  int clips = 0;

  void operator()(const DrawnPolygon& shape) {
    body += "<polygon" + pointsText(shape.points) + paintText(shape.paint) + " stroke-linejoin=\"round\"/>\n";
  }
  void operator()(const DrawnLine& shape) {
    body += "<polyline" + pointsText(shape.points) + paintText(shape.paint) +
            " stroke-linejoin=\"round\" stroke-linecap=\"butt\"/>\n";
  }
  void operator()(const DrawnCircle& shape) {
    body += "<circle" + attribute("cx", shape.centre.x) + attribute("cy", shape.centre.y) +
            attribute("r", shape.radius) + paintText(shape.paint) + "/>\n";
  }
  void operator()(const DrawnText& shape) {
    body += "<text" + attribute("x", shape.at.x) + attribute("y", shape.at.y) +
            attribute("font-size", shape.size) + attribute("fill", shape.colour) + anchorText(shape.anchor) +
            (shape.bold ? " font-weight=\"600\"" : "");
    if (!shape.halo.empty()) {
      body += attribute("stroke", shape.halo) +
              " stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
    }
    body += ">" + escaped(shape.text) + "</text>\n";
  }
  void operator()(const DrawnImage& shape) {
    const std::string id = "clip" + std::to_string(clips++);
    std::string matrix;
    for (const double m : {shape.along_u.x, shape.along_u.y, shape.along_v.x, shape.along_v.y, shape.origin.x,
                           shape.origin.y}) {
      matrix += (matrix.empty() ? "" : " ") + fixed(m, 6);
    }
    const bool jpeg = shape.bytes.starts_with("\xff\xd8");
    body += "<clipPath id=\"" + id + "\"><rect" + attribute("x", shape.clip.left) +
            attribute("y", shape.clip.top) + attribute("width", shape.clip.width) +
            attribute("height", shape.clip.height) + "/></clipPath><g clip-path=\"url(#" + id + ")\"><image" +
            attribute("width", std::to_string(shape.columns)) +
            attribute("height", std::to_string(shape.rows)) + " preserveAspectRatio=\"none\"" +
            attribute("transform", "matrix(" + matrix + ")") + " href=\"data:image/" +
            (jpeg ? "jpeg" : "png") + ";base64," + base64(shape.bytes) + "\"/></g>\n";
  }
};

}  // namespace

double textWidth(const std::string& text, double size, bool bold) {
  return static_cast<double>(characterCount(text)) * size * (bold ? 0.62 : 0.58);
}

std::string drawingSvg(const Drawing& drawing) {
  Writer writer;
  const std::string size = fixed(drawing.width, 0) + " " + fixed(drawing.height, 0);
  writer.body = "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 " + size +
                "\" width=\"" + fixed(drawing.width, 0) + "\" height=\"" + fixed(drawing.height, 0) +
                "\" font-family=\"system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif\">\n" +
                "<title>" + escaped(drawing.title) + "</title><desc>" + escaped(drawing.description) +
                "</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  for (const Shape& shape : drawing.shapes) std::visit(writer, shape);
  return writer.body + "</svg>\n";
}

}  // namespace pos::report
