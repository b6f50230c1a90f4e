#include "pos/filters/fuzzy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pos/core/config_checks.hpp"

namespace pos::filters {
namespace {

constexpr std::size_t kLast = kTerms - 1;
constexpr double kTie = 1e-9;  // strengths this close count as equal

using Strengths = std::array<double, kTerms>;

/// Standard deviation of a Gaussian that falls to one half after half of `spacing`.
double endSigma(double spacing) {
  static const double kHalves = 2.0 * std::sqrt(2.0 * std::numbers::ln2);
  return spacing / kHalves;
}

struct Stretch {
  double from = 0.0;
  double to = 0.0;
};

double lowSigma(const Partition& p) {
  return endSigma(p.centres[1] - p.centres[0]);
}
double highSigma(const Partition& p) {
  return endSigma(p.centres[kLast] - p.centres[kLast - 1]);
}

/// Where term k is at least `level` (0 < level <= 1), inside the partition's range.
Stretch atLeast(const Partition& p, std::size_t k, double level) {
  const double c = p.centres[k];
  if (k != 0 && k != kLast)
    return {c - (1.0 - level) * (c - p.centres[k - 1]), c + (1.0 - level) * (p.centres[k + 1] - c)};
  const double reach = (k == 0 ? lowSigma(p) : highSigma(p)) * std::sqrt(-2.0 * std::log(level));
  return k == 0 ? Stretch{c, std::min(c + reach, p.centres[kLast])}
                : Stretch{std::max(c - reach, p.centres[0]), c};
}

/// Strength of every output term: the strongest of its rules.
Strengths strengths(const FuzzyTable& table, double probability, double change) {
  const Strengths a = table.probability.at(probability);
  const Strengths b = table.change.at(change);
  Strengths s{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) {
      double& strength = s[static_cast<std::size_t>(table.rules[i][j])];
      strength = std::max(strength, std::min(a[i], b[j]));
    }
  }
  return s;
}

/// Mean of x over the union of the plateaus of the strongest terms; of their centres where these are points.
double meanOfMaxima(const Partition& output, const Strengths& s, double top) {
  double length = 0.0;
  double moment = 0.0;
  double points = 0.0;
  double centres = 0.0;
  double reached = output.centres[0];  // right end of the union so far
  for (std::size_t k = 0; k < kTerms; ++k) {
    if (s[k] < top - kTie) continue;
    const Stretch plateau = atLeast(output, k, top);
    const double from = std::max(plateau.from, reached);
    const double more = std::max(0.0, plateau.to - from);
    length += more;
    moment += more * 0.5 * (from + plateau.to);
    reached = std::max(reached, plateau.to);
    points += 1.0;
    centres += output.centres[k];
  }
  return length > kTie ? moment / length : centres / points;
}

/// Integrals of a membership and of x times it.
struct Area {
  double area = 0.0;
  double moment = 0.0;
};

Area ofLine(double from, double to, double at_from, double at_to) {
  const double h = to - from;
  return {0.5 * h * (at_from + at_to),
          h * (from * (2.0 * at_from + at_to) + to * (at_from + 2.0 * at_to)) / 6.0};
}

Area ofGaussian(double from, double to, double centre, double sigma) {
  const double a = (from - centre) / sigma;
  const double b = (to - centre) / sigma;
  const double area = sigma * std::sqrt(0.5 * std::numbers::pi) *
                      (std::erf(b / std::numbers::sqrt2) - std::erf(a / std::numbers::sqrt2));
  const double shift = sigma * sigma * (std::exp(-0.5 * a * a) - std::exp(-0.5 * b * b));
  return {area, centre * area + shift};
}

/// Every x at which one clipped term may take over from another: where a term is as high as some strength,
/// and where neighbours cross.
class Breaks {
 public:
  Breaks(const Partition& p, const Strengths& s) {
    for (const double c : p.centres) add(c);
    for (std::size_t k = 0; k + 1 < kTerms; ++k) add(0.5 * (p.centres[k] + p.centres[k + 1]));
    for (const double level : s) {
      if (level < kTie || level >= 1.0) continue;
      for (std::size_t k = 0; k < kTerms; ++k) {
        if (s[k] < kTie) continue;
        const Stretch stretch = atLeast(p, k, level);
        add(stretch.from);
        add(stretch.to);
      }
    }
    std::sort(at_.begin(), at_.begin() + static_cast<std::ptrdiff_t>(count_));
  }
  std::size_t count() const { return count_; }
  double operator[](std::size_t i) const { return at_[i]; }

 private:
  void add(double x) { at_[count_++] = x; }
  std::array<double, 2 * kTerms + 2 * kTerms * kTerms> at_{};
  std::size_t count_ = 0;
};

double clipped(const Strengths& s, const Strengths& memberships, std::size_t k) {
  return std::min(s[k], memberships[k]);
}

/// The part of the area between two breaks, where one term is on top.
Area between(const Partition& p, const Strengths& s, double from, double to) {
  const Strengths middle = p.at(0.5 * (from + to));
  std::size_t top = 0;
  for (std::size_t k = 1; k < kTerms; ++k) {
    if (clipped(s, middle, k) > clipped(s, middle, top)) top = k;
  }
  if (middle[top] >= s[top]) return ofLine(from, to, s[top], s[top]);
  if (top == 0) return ofGaussian(from, to, p.centres[0], lowSigma(p));
  if (top == kLast) return ofGaussian(from, to, p.centres[kLast], highSigma(p));
  return ofLine(from, to, p.at(from)[top], p.at(to)[top]);
}

double centroid(const Partition& output, const Strengths& s) {
  const Breaks breaks(output, s);
  Area sum;
  for (std::size_t i = 0; i + 1 < breaks.count(); ++i) {
    if (breaks[i + 1] - breaks[i] < 1e-12) continue;
    const Area part = between(output, s, breaks[i], breaks[i + 1]);
    sum.area += part.area;
    sum.moment += part.moment;
  }
  return sum.moment / sum.area;
}

RuleTable rulesFrom(const std::array<std::array<int, kTerms>, kTerms>& numbers) {
  RuleTable rules{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) rules[i][j] = static_cast<Term>(numbers[i][j]);
  }
  return rules;
}

void requireRising(const Partition& p, const std::string& key) {
  for (std::size_t k = 0; k + 1 < kTerms; ++k)
    require(p.centres[k] < p.centres[k + 1], key, "five centres, each above the one before");
}

}  // namespace

std::string_view name(Term term) {
  static constexpr std::array<std::string_view, kTerms> kNames{"VS", "S", "M", "L", "VL"};
  return kNames[static_cast<std::size_t>(term)];
}

std::array<double, kTerms> Partition::at(double x) const {
  std::array<double, kTerms> m{};
  x = std::clamp(x, centres[0], centres[kLast]);
  const double a = (x - centres[0]) / lowSigma(*this);
  const double b = (x - centres[kLast]) / highSigma(*this);
  m[0] = std::exp(-0.5 * a * a);
  m[kLast] = std::exp(-0.5 * b * b);
  for (std::size_t k = 1; k < kLast; ++k) {
    const double c = centres[k];
    const double slope =
        x < c ? (x - centres[k - 1]) / (c - centres[k - 1]) : (centres[k + 1] - x) / (centres[k + 1] - c);
    m[k] = std::max(0.0, slope);
  }
  return m;
}

RuleTable symmetricRules() {
  return rulesFrom({{{0, 0, 0, 1, 2}, {0, 0, 1, 2, 2}, {1, 1, 2, 3, 3}, {2, 2, 3, 4, 4}, {2, 3, 4, 4, 4}}});
}

RuleTable printedRules() {
  RuleTable rules = symmetricRules();
  rules[kLast][0] = Term::Large;
  return rules;
}

FuzzyTable validated(FuzzyTable table) {
  requireRising(table.probability, "probability");
  requireRising(table.change, "change");
  requireRising(table.output, "output");
  return table;
}

FuzzyConfig validated(FuzzyConfig config) {
  requireNotNegative(config.gain, "gain");
  require(config.gain <= 0.6, "gain", "at most 0.6, beyond which a step may double");
  return config;
}

FuzzyTable tableOf(const FuzzyConfig& config) {
  FuzzyTable table;
  table.rules = config.rules;
  if (config.variant == FuzzyVariant::Paper && config.rules == symmetricRules()) table.rules = printedRules();
  const bool maxima = config.variant == FuzzyVariant::Paper || config.variant == FuzzyVariant::PaperSym;
  if (maxima) table.defuzzification = Defuzzification::MeanOfMaxima;
  return table;
}

double evaluated(const FuzzyTable& table, double probability, double change) {
  const Strengths s = strengths(table, probability, change);
  const double top = *std::max_element(s.begin(), s.end());
  if (top < kTie) return probability;
  return table.defuzzification == Defuzzification::MeanOfMaxima ? meanOfMaxima(table.output, s, top)
                                                                : centroid(table.output, s);
}

double FuzzyController::controlled(double before, double bayes) const {
  const double change = bayes - before;
  const double there = evaluated(table_, before, change);
  if (config_.variant != FuzzyVariant::Incremental) return there;
  const double here = evaluated(table_, before, 0.0);
  // The centroid is not quite monotone near the ends (3e-4): a correction never points against the change.
  const double correction = (there - here) * change > 0.0 ? config_.gain * (there - here) : 0.0;
  return std::clamp(bayes + correction, 0.0, 1.0);
}

}  // namespace pos::filters
