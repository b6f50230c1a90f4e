#include "replay/serve_bench.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace pos::replay {

std::string feedLines(int from, int to) {
  std::ostringstream lines;
  lines << std::fixed << std::setprecision(9);
  for (int i = from; i < to; ++i) {
    const std::string stamp =
        std::to_string(1000 + i / 20) + "." + std::to_string(100 + 5 * (i % 20)).substr(1);
    const double x = 2.0 + 0.05 * i;
    lines << R"({"stamp_s": )" << stamp
          << R"(, "sensor": "wheels", "reading": "odometry", "x_m": 0.05, "interval_s": 0.05})"
          << "\n";
    for (int anchor = 1; anchor <= 4; ++anchor) {
      const double dx = (anchor % 2 == 0 ? 100.0 : 0.0) - x;
      const double dy = (anchor > 2 ? 10.0 : -10.0) - 0.3;
      lines << R"({"stamp_s": )" << stamp << R"(, "sensor": "uwb", "reading": "range", "anchor": )" << anchor
            << R"(, "range_m": )" << std::sqrt(dx * dx + dy * dy) << "}\n";
    }
  }
  return lines.str();
}

}  // namespace pos::replay
