#include "pos/report/figures.hpp"

#include "figure_parts.hpp"

namespace pos::report {

double runLength(const eval::RunSummary& run) {
  return std::max(seconds(run.end - run.start), 1e-3);
}

bool wantsLogarithm(double smallest, double largest) {
  return smallest > 0.0 && largest > 8.0 * smallest;
}

std::vector<NamedFigure> figures(const eval::RunSummary& run) {
  std::vector<std::optional<NamedFigure>> all{planFigure(run), intervalFigure(run), modesFigure(run),
                                              errorFigure(run), cdfFigure(run)};
  for (std::size_t i = 0; i < run.estimators.size(); ++i) all.push_back(componentFigure(run, i));
  for (const auto draw :
       {neesFigure, sensorVerdictFigure, anchorVerdictFigure, residualFigure, computeFigure}) {
    all.push_back(draw(run));
  }
  std::vector<NamedFigure> drawn;
  for (auto& figure : all) {
    if (figure) drawn.push_back(std::move(*figure));
  }
  return drawn;
}

}  // namespace pos::report
