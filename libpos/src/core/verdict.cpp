#include "pos/core/verdict.hpp"

namespace pos {

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Applied:
      return "applied";
    case Verdict::Gated:
      return "gated";
    case Verdict::TooOld:
      return "too_old";
    case Verdict::Unsupported:
      return "unsupported";
    case Verdict::Degenerate:
      return "degenerate";
    case Verdict::NotInitialised:
      return "not_initialised";
  }
  return "unknown";
}

}  // namespace pos
