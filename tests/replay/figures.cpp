#include "replay/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace pos::replay {
namespace {

std::vector<Expected> readTable() {
  std::istringstream text(contents(source("tests/replay/expected.csv")));
  std::vector<Expected> rows;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    Expected row;
    std::string low;
    std::string high;
    std::getline(cells, row.run, ',');
    std::getline(cells, row.estimator, ',');
    std::getline(cells, row.metric, ',');
    std::getline(cells, low, ',');
    std::getline(cells, high, ',');
    std::getline(cells, row.reason);
    row.low = std::stod(low);
    row.high = std::stod(high);
    rows.push_back(row);
  }
  return rows;
}

void expectWithin(const Expected& row, double value) {
  std::printf("[  figure  ] %s: %s %s = %.4g, expected %g to %g\n", row.run.c_str(), row.estimator.c_str(),
              row.metric.c_str(), value, row.low, row.high);
  EXPECT_GE(value, row.low) << row.run << ": " << row.estimator << ' ' << row.metric << " (" << row.reason
                            << ')';
  EXPECT_LE(value, row.high) << row.run << ": " << row.estimator << ' ' << row.metric << " (" << row.reason
                             << ')';
}

/// One figure over all summaries, joined as the metric's first word says.
double joined(const Expected& row, const std::vector<json>& summaries) {
  const std::size_t blank = row.metric.find(' ');
  const std::string how = blank == std::string::npos ? "" : row.metric.substr(0, blank);
  const std::string path = blank == std::string::npos ? row.metric : row.metric.substr(blank + 1);
  std::vector<double> values;
  for (const json& summary : summaries) {
    for (const auto& [name, estimator] : summary.at("estimators").items()) {
      const bool one_of_several_seeds = name.starts_with(row.estimator + "_seed");
      if (name == row.estimator || one_of_several_seeds) values.push_back(at(estimator, path));
    }
  }
  if (values.empty()) throw std::runtime_error("no estimator " + row.estimator + " in " + row.run);
  if (how == "median") return median(values);
  if (how.empty() && values.size() > 1)
    throw std::runtime_error(row.metric + " needs median or worst: several runs");
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

const std::vector<Expected>& expectedFigures() {
  static const std::vector<Expected> rows = readTable();
  return rows;
}

json replayed(const Bench& bench, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "replay");
  arguments.insert(arguments.end(), {"--json", "--quiet"});
  const RunResult run = bench.pos(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "--quiet leaves warnings and errors only";
  return run.exit_code == 0 ? json::parse(run.out) : json{{"estimators", json::object()}};
}

double at(const json& object, const std::string& path) {
  const json* value = &object;
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');) value = &value->at(word);
  return value->get<double>();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at((values.size() - 1) / 2);
}

void expectFigures(const std::string& run, const std::vector<json>& summaries) {
  int rows = 0;
  for (const Expected& row : expectedFigures()) {
    if (row.run != run) continue;
    ++rows;
    expectWithin(row, joined(row, summaries));
  }
  EXPECT_GT(rows, 0) << "expected.csv says nothing of " << run;
}

void expectFigure(const std::string& run, const std::string& estimator, const std::string& metric,
                  double value) {
  for (const Expected& row : expectedFigures()) {
    if (row.run == run && row.estimator == estimator && row.metric == metric) return expectWithin(row, value);
  }
  ADD_FAILURE() << "expected.csv says nothing of " << run << ", " << estimator << ", " << metric;
}

}  // namespace pos::replay
