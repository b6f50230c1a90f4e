// The face in words: how straight the cuts are, where the shearer stands at the ends, what crept.
#include "face_section.hpp"

#include "html_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {
namespace {

std::string metres(const std::optional<double>& value) {
  return value ? fixed(*value, 3) : std::string(kNoValue);
}

std::string left(const std::string& text) {
  return "<td style=\"text-align:left\">" + escaped(text) + "</td>";
}

std::string head(const std::vector<std::string>& columns) {
  std::string html = "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">estimator</th>";
  for (const std::string& column : columns) html += "<th scope=\"col\">" + escaped(column) + "</th>";
  return html + "</tr></thead><tbody>\n";
}

std::string cutRows(const eval::EstimatorFace& estimator) {
  std::string html;
  for (const eval::Cut& cut : estimator.face.cuts) {
    if (cut.profile.empty()) continue;
    const double way = cut.profile.back().station - cut.profile.front().station;
    html +=
        "<tr><th scope=\"row\">" + escaped(estimator.name) + "</th>" +
        element("td", std::to_string(cut.number)) +
        left(std::string("to end ") + std::to_string(cut.to_end) + (cut.complete ? "" : ", not finished")) +
        element("td", fixed(way, 0)) + element("td", metres(cut.bend_range)) +
        element("td", metres(cut.true_bend_range)) + element("td", metres(cut.bend_error)) + "</tr>\n";
  }
  return html;
}

std::string standRows(const eval::EstimatorFace& estimator) {
  std::string html;
  for (const eval::FaceStand& stand : estimator.face.stands) {
    html += "<tr><th scope=\"row\">" + escaped(estimator.name) + "</th>" +
            element("td", std::to_string(stand.cut + (stand.after ? 1 : 0))) +
            left("end " + std::to_string(stand.end) + (stand.after ? ", cut begins" : ", cut is done"));
    for (int i = 0; i < 3; ++i) html += element("td", metres(stand.place[i]));
    for (int i = 0; i < 3; ++i)
      html += element("td", stand.error ? metres((*stand.error)[i]) : std::string(kNoValue));
    html += "</tr>\n";
  }
  return html;
}

std::string operationRows(const eval::EstimatorFace& estimator) {
  std::string html;
  for (const eval::EndOperation& operation : estimator.face.operations) {
    html += "<tr><th scope=\"row\">" + escaped(estimator.name) + "</th>" +
            element("td", std::to_string(operation.number)) + left("end " + std::to_string(operation.end)) +
            element("td", operation.creep ? fixed(*operation.creep, 4) : std::string(kNoValue)) +
            element("td", operation.creep ? fixed(operation.creep_sigma, 4) : std::string(kNoValue)) +
            element("td", metres(operation.moved.y())) +
            element("td", operation.truth ? fixed(operation.truth->y(), 4) : std::string(kNoValue)) +
            element("td", metres(operation.moved.x())) +
            element("td", operation.truth ? metres(operation.truth->x()) : std::string(kNoValue)) + "</tr>\n";
  }
  return html;
}

/// A table with its heading and note; empty without rows.
std::string table(const std::string& title, const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& note) {
  if (rows.empty()) return "";
  return element("h3", escaped(title)) + "\n" + head(columns) + rows + "</tbody></table></div>\n" +
         "<p class=\"note\">" + escaped(note) + "</p>\n";
}

}  // namespace

std::string faceSection(const std::vector<eval::EstimatorFace>& faces) {
  std::string cuts;
  std::string stands;
  std::string operations;
  for (const eval::EstimatorFace& estimator : faces) {
    cuts += cutRows(estimator);
    stands += standRows(estimator);
    operations += operationRows(estimator);
  }
  if (cuts.empty() && stands.empty()) return "";
  return "<h2 id=\"face\">Face</h2>\n" +
         table("Straightness of the cuts",
               {"cut", "direction", "length m", "bend m", "true bend m", "bend error m"}, cuts,
               "Bend: from the place farthest left of the straight line that fits a cut best to the one "
               "farthest right. Bend error: r.m.s. of the bend along the cut less the true one.") +
         table("Stands at the ends",
               {"cut", "place", "lateral m", "station m", "height m", "lateral error m", "station error m",
                "height error m"},
               stands,
               "Lateral: right of the line from end 1 (towards the coal); station: along it from end 1. "
               "Errors: estimate \u2212 truth.") +
         table(
             "End operations",
             {"after cut", "place", "creep m", "sigma m", "moved along m", "truly along m", "advance m",
              "true advance m"},
             operations,
             "Creep: along the face towards end 2, by sweeps of the gate road before and after. Moved along "
             "and advance: by the track, from stand to stand.");
}

}  // namespace pos::report
