#include <cmath>
#include <cstdio>
#include <numbers>

#include "pos/filters/fuzzy.hpp"

namespace pos::filters {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), " %.6g", value);
  return text.data();
}

std::string gaussian(double centre, double spacing) {
  return "Gaussian" + number(centre) + number(0.5 * spacing / std::sqrt(2.0 * std::numbers::ln2));
}

std::string terms(const Partition& p) {
  constexpr std::size_t kLast = kTerms - 1;
  const auto& c = p.centres;
  std::string text;
  for (std::size_t k = 0; k < kTerms; ++k) {
    text += "  term: " + std::string(name(static_cast<Term>(k))) + " ";
    if (k == 0) {
      text += gaussian(c[0], c[1] - c[0]);
    } else if (k == kLast) {
      text += gaussian(c[kLast], c[kLast] - c[kLast - 1]);
    } else {
      text += "Triangle" + number(c[k - 1]) + number(c[k]) + number(c[k + 1]);
    }
    text += "\n";
  }
  return text;
}

std::string variable(const std::string& kind, const std::string& called, const Partition& p,
                     const std::string& more) {
  return kind + ": " + called + "\n  enabled: true\n  range:" + number(p.centres.front()) +
         number(p.centres.back()) + "\n  lock-range: true\n" + more + terms(p);
}

std::string rules(const RuleTable& table) {
  std::string text;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) {
      const auto term = [](std::size_t k) { return std::string(name(static_cast<Term>(k))); };
      text += "  rule: if probability is " + term(i) + " and change is " + term(j) + " then next is " +
              std::string(name(table[i][j])) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string fllText(const FuzzyTable& table) {
  const bool maxima = table.defuzzification == Defuzzification::MeanOfMaxima;
  const std::string output = std::string("  aggregation: Maximum\n  defuzzifier: ") +
                             (maxima ? "MeanOfMaximum" : "Centroid") +
                             " 1001\n  default: nan\n  lock-previous: false\n";
  return "Engine: mode_probability\n" + variable("InputVariable", "probability", table.probability, "") +
         variable("InputVariable", "change", table.change, "") +
         variable("OutputVariable", "next", table.output, output) +
         "RuleBlock: rules\n  enabled: true\n  conjunction: Minimum\n  disjunction: none\n"
         "  implication: Minimum\n  activation: General\n" +
         rules(table.rules);
}

}  // namespace pos::filters
