#include "pos/core/error.hpp"

namespace pos {

std::string toString(const FilePlace& place) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  return text;
}

std::string toString(const Complaint& complaint) {
  const std::string place = toString(complaint.place);
  std::string text = place.empty() ? complaint.what : place + ": " + complaint.what;
  const auto line = [&text](const char* label, const std::string& value) {
    if (!value.empty()) text += std::string("\n  ") + label + value;
  };
  line("key:      ", complaint.key);
  line("got:      ", complaint.got);
  line("expected: ", complaint.expected);
  line("try:      ", complaint.suggestion);
  return text;
}

}  // namespace pos
