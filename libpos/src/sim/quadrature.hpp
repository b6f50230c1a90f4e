#pragma once
/// Gauss-Legendre quadrature with fixed nodes.

#include <array>
#include <cmath>

namespace pos::sim {

/// Nodes and weights of the positive half of [-1, 1]; exact for polynomials of degree 19.
inline constexpr std::array<double, 5> kNodes10 = {
    0.14887433898163121, 0.43339539412924719, 0.67940956829902441, 0.86506336668898451, 0.97390652851717172};
inline constexpr std::array<double, 5> kWeights10 = {
    0.29552422471475287, 0.26926671930999636, 0.21908636251598204, 0.14945134915058059, 0.06667134430868814};

/// Integral of `f` over [from, to] by ten nodes; `f` returns a double or an Eigen vector.
template <class F>
auto integral10(F&& f, double from, double to) -> decltype(f(from)) {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  decltype(f(from)) sum = kWeights10[0] * (f(middle - half * kNodes10[0]) + f(middle + half * kNodes10[0]));
  for (std::size_t i = 1; i < kNodes10.size(); ++i) {
    sum += kWeights10[i] * (f(middle - half * kNodes10[i]) + f(middle + half * kNodes10[i]));
  }
  return half * sum;
}

/// Calls visit(t, weight) at three nodes per panel of at most `panel`; exact for degree 5 on each.
template <class Visit>
void threeNodes(double from, double to, double panel, Visit&& visit) {
  constexpr double kNode = 0.77459666924148338;  // sqrt(3/5)
  const double panels = std::max(1.0, std::ceil((to - from) / panel - 1e-9));
  const double half = 0.5 * (to - from) / panels;
  for (int i = 0; i < static_cast<int>(panels); ++i) {
    const double middle = from + half * (2.0 * i + 1.0);
    visit(middle - half * kNode, half * (5.0 / 9.0));
    visit(middle, half * (8.0 / 9.0));
    visit(middle + half * kNode, half * (5.0 / 9.0));
  }
}

}  // namespace pos::sim
