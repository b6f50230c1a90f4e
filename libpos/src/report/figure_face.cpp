// The face drawn: the shearer's track in every cycle, the bend of every cut, the creep.
#include <algorithm>
#include <cmath>

#include "figure_parts.hpp"
#include "pos/report/face_files.hpp"

namespace pos::report {
namespace {

using eval::EstimatorFace;
using eval::FaceGeometry;

constexpr std::size_t kMostPoints = 700;  // of one cut

struct Span {
  double low = 1e300;
  double high = -1e300;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double middle() const { return 0.5 * (low + high); }
  /// Wider by a share of itself, and at least `least` wide.
  Span padded(double share, double least) const {
    const double half = std::max(0.5 * least, (0.5 + share) * (high - low));
    return {middle() - half, middle() + half};
  }
};

/// Points `first` to `past` of a track, estimate or truth, thinned.
std::vector<Pixel> trackLine(const Plot& plot, const FaceGeometry& face, std::size_t first, std::size_t past,
                             std::optional<Eigen::Vector3d> (*pick)(const eval::FacePoint&)) {
  std::vector<Pixel> line;
  const std::size_t stride = std::max<std::size_t>(1, (past - first + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = first; i < past; i += stride) {
    if (const auto p = pick(face.track[i])) line.push_back(plot(p->y(), p->x()));
  }
  return line;
}

std::optional<Eigen::Vector3d> estimated(const eval::FacePoint& point) {
  return point.place;
}
std::optional<Eigen::Vector3d> real(const eval::FacePoint& point) {
  return point.truth;
}

void drawCycle(Svg& svg, const Plot& plot, const FaceGeometry& face, std::size_t k) {
  const eval::Cut& cut = face.cuts[k];
  const std::size_t next = k + 1 < face.cuts.size() ? face.cuts[k + 1].first + 1 : face.track.size();
  svg.polyline(trackLine(plot, face, cut.first, cut.past, real), "truth");
  if (cut.past < next) svg.polyline(trackLine(plot, face, cut.past - 1, next, estimated), "zero dash");
  svg.polyline(trackLine(plot, face, cut.first, cut.past, estimated), strokeClass(k));
}

/// The half height of the panels of bends, m.
double bendHeight(const FaceGeometry& face) {
  double half = 0.02;
  for (const eval::Cut& cut : face.cuts) {
    for (const eval::ProfilePoint& p : cut.profile)
      half = std::max({half, std::abs(p.bend), p.true_bend ? std::abs(*p.true_bend) : 0.0});
  }
  return 1.1 * half;
}

void drawBend(Svg& svg, const Plot& plot, const eval::Cut& cut, std::size_t k) {
  std::vector<Pixel> line;
  std::vector<Pixel> truth;
  for (const eval::ProfilePoint& p : cut.profile) {
    line.push_back(plot(p.station, p.bend));
    if (p.true_bend) truth.push_back(plot(p.station, *p.true_bend));
  }
  svg.beginClip(plot.box);
  svg.line({plot.box.left, plot.y(0.0)}, {plot.box.right(), plot.y(0.0)}, "zero");
  if (!truth.empty()) svg.polyline(truth, "truth");
  svg.polyline(line, strokeClass(k));
  svg.endClip();
}

std::optional<NamedFigure> faceTrackFigure(const std::vector<EstimatorFace>& faces, std::size_t index) {
  const EstimatorFace& estimator = faces[index];
  const FaceGeometry& face = estimator.face;
  if (face.cuts.empty()) return std::nullopt;
  Span stations;
  Span laterals;
  bool with_truth = false;
  for (const eval::FacePoint& point : face.track) {
    stations.add(point.place.y());
    laterals.add(point.place.x());
    with_truth = with_truth || point.truth.has_value();
    if (point.truth) laterals.add(point.truth->x());
  }
  std::vector<LegendEntry> legend;
  for (std::size_t k = 0; k < face.cuts.size(); ++k)
    legend.push_back({"cut " + std::to_string(face.cuts[k].number), strokeClass(k)});
  if (!face.operations.empty()) legend.push_back({"end operation", "zero dash"});
  if (with_truth) legend.push_back({"truth of the cut", "truth"});
  const std::string title = "Track of the shearer by cycle, " + shortened(estimator.name, 40);
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Box box{kLeft, top, kPlotWidth, 330.0};
  const Span x = stations.padded(0.02, 1.0);
  const Span y = laterals.padded(0.06, 0.2);
  const Plot plot = plotOver(box, x.low, x.high, y.low, y.high);
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "Lateral place along the face for every cut");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"station from end 1 (m)", "lateral, towards the coal (m)"});
  svg.beginClip(box);
  for (std::size_t k = 0; k < face.cuts.size(); ++k) drawCycle(svg, plot, face, k);
  svg.endClip();
  return NamedFigure{
      "face_track_" + std::to_string(index + 1), title,
      "The face from above; the lateral axis is stretched, so that centimetres of bend show beside "
      "metres of advance. One line a cut; the conveyor moves on between them.",
      svg.str()};
}

std::optional<NamedFigure> faceBendFigure(const std::vector<EstimatorFace>& faces, std::size_t index) {
  const EstimatorFace& estimator = faces[index];
  const FaceGeometry& face = estimator.face;
  if (face.cuts.empty()) return std::nullopt;
  std::vector<const eval::Cut*> cuts;
  Span stations;
  bool with_truth = false;
  for (const eval::Cut& cut : face.cuts) {
    if (cut.profile.empty()) continue;
    cuts.push_back(&cut);
    stations.add(cut.profile.front().station);
    stations.add(cut.profile.back().station);
    with_truth = with_truth || cut.true_bend_range.has_value();
  }
  if (cuts.empty()) return std::nullopt;
  std::vector<LegendEntry> legend{{"by " + shortened(estimator.name, kNameCharacters), strokeClass(0)}};
  if (with_truth) legend.push_back({"truth", "truth"});
  constexpr double kPanel = 84.0;
  constexpr double kBetween = 26.0;
  const std::string title = "Straightness of the cuts, " + shortened(estimator.name, 40);
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 26.0;
  const double height = static_cast<double>(cuts.size()) * (kPanel + kBetween) - kBetween;
  const double half = bendHeight(face);
  Svg svg(kFigureWidth, top + height + kBelow, title, "Bend of every cut off its straight line");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const eval::Cut& cut = *cuts[k];
    const Box box{kLeft, top + static_cast<double>(k) * (kPanel + kBetween), kPlotWidth, kPanel};
    const Plot plot = plotOver(box, stations.low, stations.high, -half, half);
    drawAxes(svg, plot, {k + 1 == cuts.size() ? "station from end 1 (m)" : "", "bend (m)"});
    svg.text({kLeft, box.top - 6.0},
             "cut " + std::to_string(cut.number) + " to end " + std::to_string(cut.to_end) + ": " +
                 fixed(cut.bend_range, 3) + " m from side to side" +
                 (cut.true_bend_range ? ", truly " + fixed(*cut.true_bend_range, 3) + " m" : ""),
             "start small strong");
    drawBend(svg, plot, cut, 0);
  }
  return NamedFigure{
      "face_bend_" + std::to_string(index + 1), title,
      "How far each cut strays from the straight line that fits it best, towards the coal upwards: "
      "what the next advance has to straighten.",
      svg.str()};
}

std::optional<NamedFigure> creepFigure(const std::vector<EstimatorFace>& faces) {
  Span numbers;
  Span values;
  bool with_truth = false;
  const auto has_creep = [](const EstimatorFace& e) {
    return std::any_of(e.face.operations.begin(), e.face.operations.end(),
                       [](const auto& operation) { return operation.creep.has_value(); });
  };
  for (const EstimatorFace& estimator : faces) {
    if (!has_creep(estimator)) continue;
    for (const eval::EndOperation& operation : estimator.face.operations) {
      if (!operation.creep) continue;
      numbers.add(operation.number);
      values.add(*operation.creep);
      if (operation.truth) values.add(operation.truth->y());
      with_truth = with_truth || operation.truth.has_value();
    }
  }
  if (numbers.low > numbers.high) return std::nullopt;
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (has_creep(faces[i])) legend.push_back({shortened(faces[i].name, kNameCharacters), strokeClass(i)});
  }
  if (with_truth) legend.push_back({"truth", "truth"});
  const std::string title = "Creep of the face in every end operation";
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Box box{kLeft, top, kPlotWidth, 240.0};
  const Span y = values.padded(0.15, 0.02);
  const Plot plot = plotOver(box, numbers.low - 0.5, numbers.high + 0.5, y.low, y.high);
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "Creep along the face by sweeps of the gate roads");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"end operation", "creep towards end 2 (m)"});
  svg.beginClip(box);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!has_creep(faces[i])) continue;
    const double aside = 0.12 * static_cast<double>(shown++);
    for (const eval::EndOperation& operation : faces[i].face.operations) {
      if (!operation.creep) continue;
      const double x = operation.number;
      if (operation.truth && aside == 0.0)
        svg.line(plot(x - 0.35, operation.truth->y()), plot(x + 0.35, operation.truth->y()), "truth");
      const double reach = 3.0 * operation.creep_sigma;
      svg.line(plot(x + aside, *operation.creep - reach), plot(x + aside, *operation.creep + reach),
               strokeClass(i) + " curve");
      svg.circle(plot(x + aside, *operation.creep), 4.0, fillClass(i));
    }
  }
  svg.endClip();
  return NamedFigure{"creep", title,
                     "Points with bars of 3 sigma; negative is towards roadway 1. Measured by registering "
                     "sweeps of the gate road before and after the end operation.",
                     svg.str()};
}

}  // namespace

std::vector<NamedFigure> faceFigures(const std::vector<EstimatorFace>& faces) {
  std::vector<std::optional<NamedFigure>> all;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    all.push_back(faceTrackFigure(faces, i));
    all.push_back(faceBendFigure(faces, i));
  }
  all.push_back(creepFigure(faces));
  std::vector<NamedFigure> drawn;
  for (auto& figure : all) {
    if (figure) drawn.push_back(std::move(*figure));
  }
  return drawn;
}

}  // namespace pos::report
