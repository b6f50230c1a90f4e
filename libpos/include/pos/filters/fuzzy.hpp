#pragma once
/// The fuzzy controller of the seamless paper (J. China Coal Soc. 2024, section 2.2, equations 19 and 20,
/// tables 3): from a mode's probability of the cycle before and its change to the probability it gets.
///
/// I1 = probability before, 0..1    dI = change the likelihoods ask for, -1..1    I2 = output, 0..1
/// Mamdani: AND and implication by minimum, aggregation by maximum. The paper's membership functions are a
/// drawing only; here Gaussians at both ends and triangles between, neighbours crossing at one half.

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "pos/core/manifold.hpp"

namespace pos::filters {

/// Terms of all three variables, in order.
enum class Term { VerySmall, Small, Medium, Large, VeryLarge };
inline constexpr std::size_t kTerms = 5;
/// "VS", "S", "M", "L", "VL".
std::string_view name(Term term);

/// Membership functions of one variable: term k reaches 1 at `centres[k]`. The terms between the ends are
/// triangles whose feet are the neighbours' centres, the ends are Gaussians that fall to one half midway to
/// their neighbour.
struct Partition {
  std::array<double, kTerms> centres = {0.0, 0.25, 0.5, 0.75, 1.0};

  /// Memberships of a value inside the range (a value outside counts as its end).
  std::array<double, kTerms> at(double x) const;

  bool operator==(const Partition&) const = default;
};

/// rules[I1][dI].
using RuleTable = std::array<std::array<Term, kTerms>, kTerms>;
/// Table 3 as printed. Its cell (VL, VS) = L breaks the complement symmetry of all others.
RuleTable printedRules();
/// The same with (VL, VS) = M.
RuleTable symmetricRules();

/// How the output set becomes a number. Both are exact, not sums over a grid.
enum class Defuzzification {
  MeanOfMaxima,  ///< mean over all points of greatest membership
  Centroid,      ///< of the area
};

struct FuzzyTable {
  Partition probability;                             ///< I1
  Partition change = {{-1.0, -0.5, 0.0, 0.5, 1.0}};  ///< dI
  Partition output;                                  ///< I2
  RuleTable rules = symmetricRules();
  Defuzzification defuzzification = Defuzzification::Centroid;

  bool operator==(const FuzzyTable&) const = default;
};
/// Throws ConfigError when centres do not rise.
FuzzyTable validated(FuzzyTable table);

/// I2. Where no rule fires at all: `probability`.
double evaluated(const FuzzyTable& table, double probability, double change);

/// How fuzzy control changes the mode probabilities.
enum class FuzzyVariant {
  Paper,        ///< printed table, mean of maxima
  PaperSym,     ///< symmetric table, mean of maxima
  Centroid,     ///< symmetric table, centroid
  Incremental,  ///< a correction on top of Bayes: mu + gain (D(I1, dI) - D(I1, 0)), D the centroid
};
struct FuzzyConfig {
  FuzzyVariant variant = FuzzyVariant::Incremental;
  double gain = 0.5;  ///< of `Incremental`, at most 0.6: D rises by up to 1.6 per dI, and no step may double
  RuleTable rules = symmetricRules();  ///< `Paper` has its own unless these were changed

  bool operator==(const FuzzyConfig&) const = default;
};
FuzzyConfig validated(FuzzyConfig config);
/// The controller's table: the variant's rules, unless others than the default are given.
FuzzyTable tableOf(const FuzzyConfig& config);

/// Probabilities after the controller: `before` of the cycle before, `bayes` of this one by Bayes' rule. Each
/// lies in 0..1 and they sum to one.
class FuzzyController {
 public:
  explicit FuzzyController(const FuzzyConfig& config) : config_(validated(config)), table_(tableOf(config)) {}

  template <int N>
  Vector<N> controlled(const Vector<N>& before, const Vector<N>& bayes) const {
    Vector<N> mu;
    for (int j = 0; j < N; ++j) mu[j] = controlled(before[j], bayes[j]);
    const double sum = mu.sum();
    return sum > 0.0 ? Vector<N>(mu / sum) : bayes;
  }
  const FuzzyTable& table() const { return table_; }

 private:
  double controlled(double before, double bayes) const;

  FuzzyConfig config_;
  FuzzyTable table_;
};

/// The controller as text of the FuzzyLite language (.fll), for drawing and for other programs.
std::string fllText(const FuzzyTable& table);

}  // namespace pos::filters
