// The drawing list painted with OpenCV.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "pos/core/error.hpp"
#include "pos/report/drawing.hpp"
#include "pos/report/text.hpp"

namespace pos::report {
namespace {

constexpr int kShift = 4;  // fractional bits of OpenCV's fixed-point coordinates
constexpr int kOversampling = 2;
constexpr double kMostPixels = 2e8;

cv::Scalar colourOf(const Colour& colour) {
  unsigned value = 0;
  if (colour.size() == 7) std::from_chars(colour.data() + 1, colour.data() + 7, value, 16);
  return {static_cast<double>(value & 255U), static_cast<double>((value >> 8U) & 255U),
          static_cast<double>((value >> 16U) & 255U)};
}

/// Hershey's letters are 21 units high from base line to capital height at scale 1 (22 with the stroke).
double fontScale(double size) {
  return 0.72 * size / 21.0;
}

std::string asciiOnly(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 32 && byte < 127) plain += c;
    if (byte >= 0xC0) plain += '?';  // the first byte of a longer character
  }
  return plain;
}

/// Stretch of the line from `a` to `b` inside the box, as shares of its length; end < begin where there is
/// none.
struct Seen {
  double begin = 0.0;
  double end = 1.0;
};
Seen seenPart(const Pixel& a, const Pixel& b, const Box& box) {
  Seen seen;
  const auto clip = [&seen](double from, double step, double low, double high) {
    if (step == 0.0) {
      if (from < low || from > high) seen.end = -1.0;
      return;
    }
    seen.begin = std::max(seen.begin, std::min((low - from) / step, (high - from) / step));
    seen.end = std::min(seen.end, std::max((low - from) / step, (high - from) / step));
  };
  clip(a.x, b.x - a.x, box.left, box.right());
  clip(a.y, b.y - a.y, box.top, box.bottom());
  return seen;
}

/// The parts of a line that a dash pattern leaves inside the box; a typing mistake in a map may draw a line a
/// million sheets long.
std::vector<std::vector<Pixel>> dashed(const std::vector<Pixel>& line, const std::vector<double>& dash,
                                       const Box& box) {
  if (dash.empty()) return {line};
  const double period = std::accumulate(dash.begin(), dash.end(), 0.0);
  std::vector<std::vector<Pixel>> parts;
  double behind = 0.0;  // length of the segments drawn so far
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Pixel& a = line[i];
    const Pixel& b = line[i + 1];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const Seen seen = seenPart(a, b, box);
    const auto point = [&](double s) {
      return Pixel{a.x + s / length * (b.x - a.x), a.y + s / length * (b.y - a.y)};
    };
    for (double s = seen.begin * length; s < seen.end * length;) {
      double left = std::fmod(behind + s, period);
      std::size_t at = 0;
      while (at + 1 < dash.size() && left >= dash[at]) left -= dash[at++];
      const double step = std::min(std::max(dash[at] - left, 0.1), seen.end * length - s);
      if (at % 2 == 0) parts.push_back({point(s), point(s + step)});
      s += step;
    }
    behind += length;
  }
  return parts;
}

/// In three colours, with white where the picture is transparent.
cv::Mat onWhite(cv::Mat image) {
  if (image.empty()) return image;
  if (image.depth() != CV_8U) image.convertTo(image, CV_8U, 1.0 / 257.0);
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  if (image.channels() != 4) return image;
  cv::Mat opaque(image.size(), CV_8UC3);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const auto& from = image.at<cv::Vec4b>(row, column);
      for (int k = 0; k < 3; ++k) {
        opaque.at<cv::Vec3b>(row, column)[k] =
            static_cast<std::uint8_t>((from[k] * from[3] + 255 * (255 - from[3]) + 127) / 255);
      }
    }
  }
  return opaque;
}

class Painter {
 public:
  Painter(cv::Mat& canvas, double scale) : canvas_(canvas), scale_(scale) {}

  void operator()(const DrawnPolygon& shape) {
    if (shape.points.size() < 2) return;
    const auto points = fixedPoint(shape.points);
    if (!shape.paint.fill.empty()) {
      cv::fillPoly(canvas_, std::vector<std::vector<cv::Point>>{points}, colourOf(shape.paint.fill),
                   cv::LINE_AA, kShift);
    }
    std::vector<Pixel> closed = shape.points;
    closed.push_back(closed.front());
    stroke(closed, shape.paint);
  }
  void operator()(const DrawnLine& shape) { stroke(shape.points, shape.paint); }
  void operator()(const DrawnCircle& shape) {
    const cv::Point centre = fixedPoint(shape.centre);
    const int radius = static_cast<int>(std::lround(shape.radius * scale_ * (1 << kShift)));
    if (!shape.paint.fill.empty()) {
      cv::circle(canvas_, centre, radius, colourOf(shape.paint.fill), cv::FILLED, cv::LINE_AA, kShift);
    }
    if (!shape.paint.stroke.empty()) {
      cv::circle(canvas_, centre, radius, colourOf(shape.paint.stroke), thickness(shape.paint), cv::LINE_AA,
                 kShift);
    }
  }
  void operator()(const DrawnText& shape) {
    const std::string text = asciiOnly(shape.text);
    const double font = fontOf(shape, text);
    const int pen =
        std::max(1, static_cast<int>(std::lround(shape.size * scale_ * (shape.bold ? 0.13 : 0.085))));
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font, pen, nullptr);
    double x = shape.at.x * scale_;
    if (shape.anchor == TextAnchor::Middle) x -= 0.5 * size.width;
    if (shape.anchor == TextAnchor::End) x -= size.width;
    const cv::Point at(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(shape.at.y * scale_)));
    if (!shape.halo.empty()) {
      const int broad = pen + static_cast<int>(std::lround(3.0 * scale_));
      cv::putText(canvas_, text, at, cv::FONT_HERSHEY_SIMPLEX, font, colourOf(shape.halo), broad,
                  cv::LINE_AA);
    }
    cv::putText(canvas_, text, at, cv::FONT_HERSHEY_SIMPLEX, font, colourOf(shape.colour), pen, cv::LINE_AA);
  }
  void operator()(const DrawnImage& shape) {
    const std::vector<unsigned char> bytes(shape.bytes.begin(), shape.bytes.end());
    const cv::Mat image = onWhite(cv::imdecode(bytes, cv::IMREAD_UNCHANGED));
    if (image.empty()) {
      throw DataError(
          Complaint{.what = "a picture of the drawing cannot be decoded", .expected = "PNG or JPEG"});
    }
    // warpAffine counts from the middle of a pixel.
    const double ux = shape.along_u.x * scale_, uy = shape.along_u.y * scale_;
    const double vx = shape.along_v.x * scale_, vy = shape.along_v.y * scale_;
    const double ox = shape.origin.x * scale_ + 0.5 * (ux + vx) - 0.5;
    const double oy = shape.origin.y * scale_ + 0.5 * (uy + vy) - 0.5;
    const cv::Mat matrix = (cv::Mat_<double>(2, 3) << ux, vx, ox, uy, vy, oy);
    cv::Mat warped;
    cv::warpAffine(image, warped, matrix, canvas_.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                   cv::Scalar(255, 255, 255));
    const cv::Rect clip =
        cv::Rect(static_cast<int>(shape.clip.left * scale_), static_cast<int>(shape.clip.top * scale_),
                 static_cast<int>(shape.clip.width * scale_), static_cast<int>(shape.clip.height * scale_)) &
        cv::Rect(0, 0, canvas_.cols, canvas_.rows);
    warped(clip).copyTo(canvas_(clip));
  }

 private:
  cv::Point fixedPoint(const Pixel& p) const {
    const double factor = scale_ * (1 << kShift);
    const auto limited = [](double v) { return static_cast<int>(std::lround(std::clamp(v, -1e8, 1e8))); };
    return {limited(p.x * factor), limited(p.y * factor)};
  }
  std::vector<cv::Point> fixedPoint(const std::vector<Pixel>& points) const {
    std::vector<cv::Point> out;
    out.reserve(points.size());
    for (const Pixel& p : points) out.push_back(fixedPoint(p));
    return out;
  }
  /// As large as asked for, but no wider than the SVG's letters.
  double fontOf(const DrawnText& shape, const std::string& text) const {
    const double font = fontScale(shape.size) * scale_;
    const double width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font, 1, nullptr).width;
    const double wanted = textWidth(text, shape.size, shape.bold) * scale_;
    return width > wanted ? font * wanted / width : font;
  }
  int thickness(const Paint& paint) const {
    return std::max(1, static_cast<int>(std::lround(paint.stroke_width * scale_)));
  }
  void stroke(const std::vector<Pixel>& line, const Paint& paint) {
    if (paint.stroke.empty()) return;
    const double margin = paint.stroke_width;
    const Box sheet{-margin, -margin, canvas_.cols / scale_ + 2.0 * margin,
                    canvas_.rows / scale_ + 2.0 * margin};
    for (const auto& part : dashed(line, paint.dash, sheet)) {
      cv::polylines(canvas_, std::vector<std::vector<cv::Point>>{fixedPoint(part)}, false,
                    colourOf(paint.stroke), thickness(paint), cv::LINE_AA, kShift);
    }
  }

  cv::Mat& canvas_;
  double scale_;
};

}  // namespace

std::string drawingPng(const Drawing& drawing, double scale) {
  const double columns = std::round(drawing.width * scale);
  const double rows = std::round(drawing.height * scale);
  if (!(columns >= 1.0 && rows >= 1.0 && columns * rows * kOversampling * kOversampling <= kMostPixels)) {
    throw ConfigError(Complaint{.what = "the picture is too large to paint",
                                .got = fixed(columns, 0) + " x " + fixed(rows, 0) + " pixels",
                                .expected = "at most 5e7 pixels",
                                .suggestion = "ask for a smaller width, or for SVG"});
  }
  cv::Mat canvas(static_cast<int>(rows) * kOversampling, static_cast<int>(columns) * kOversampling, CV_8UC3,
                 cv::Scalar(255, 255, 255));
  Painter painter(canvas, scale * kOversampling);
  for (const Shape& shape : drawing.shapes) std::visit(painter, shape);
  cv::Mat shrunk;
  cv::resize(canvas, shrunk, cv::Size(static_cast<int>(columns), static_cast<int>(rows)), 0, 0,
             cv::INTER_AREA);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", shrunk, bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace pos::report
