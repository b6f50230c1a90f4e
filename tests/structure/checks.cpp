#include "structure/checks.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace pos::structure {
namespace {

/// Every match of `pattern`, line by line, with `what` in front of the matched text.
Findings matches(std::string_view text, const std::regex& pattern, const std::string& what) {
  Findings findings;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match) {
      findings.push_back({number, what + match->str()});
    }
  }
  return findings;
}

std::string moduleOf(const std::string& file) {
  return file.substr(0, file.find('/'));
}

/// Why `file` may not include `header`, or nothing.
std::string objection(const Arrows& arrows, const std::string& file, const std::string& header) {
  if (header.find("..") != std::string::npos) return "include climbs out of its folder: " + header;
  const std::string owner = moduleOf(file);
  if (header.rfind("pos/", 0) == 0) {
    const std::string target = moduleOf(header.substr(4));
    const auto allowed = arrows.modules.find(owner);
    if (allowed == arrows.modules.end()) return "module missing in arrows.txt: " + owner;
    if (target == owner || allowed->second.count(target) > 0) return {};
    return owner + " may not include " + header;
  }
  const auto library = arrows.libraries.find(moduleOf(header));
  if (library == arrows.libraries.end()) return {};
  if (library->second.count(owner) > 0 || library->second.count(file) > 0) return {};
  return file + " may not include " + header;
}

}  // namespace

Arrows parsedArrows(std::string_view table) {
  Arrows arrows;
  std::map<std::string, std::set<std::string>>* section = nullptr;
  std::istringstream lines{std::string(table)};
  std::string line;
  while (std::getline(lines, line)) {
    if (line.empty() || line.front() == '#') continue;
    if (line == "[modules]" || line == "[libraries]") {
      section = line == "[modules]" ? &arrows.modules : &arrows.libraries;
      continue;
    }
    const std::size_t colon = line.find(':');
    if (section == nullptr || colon == std::string::npos) throw std::runtime_error("arrows.txt: " + line);
    std::istringstream names(line.substr(colon + 1));
    std::set<std::string>& allowed = (*section)[line.substr(0, colon)];
    for (std::string name; names >> name;) allowed.insert(name);
  }
  return arrows;
}

std::string withoutComments(std::string_view source) {
  enum class In { Code, Text, Character, Line, Block } in = In::Code;
  std::string code(source);
  const auto blank = [&code](std::size_t i) {
    if (code[i] != '\n') code[i] = ' ';
  };
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char here = source[i];
    const char next = i + 1 < source.size() ? source[i + 1] : '\0';
    const bool digit_mark = here == '\'' && i > 0 && std::isalnum(static_cast<unsigned char>(source[i - 1]));
    switch (in) {
      case In::Code:
        if (here == '/' && (next == '/' || next == '*')) {
          in = next == '/' ? In::Line : In::Block;
          blank(i);
        } else if (here == '"') {
          in = In::Text;
        } else if (here == '\'' && !digit_mark) {
          in = In::Character;
        }
        break;
      case In::Text:
      case In::Character:
        if (here == '\\') {
          ++i;
        } else if (here == (in == In::Text ? '"' : '\'')) {
          in = In::Code;
        }
        break;
      case In::Line:
        if (here == '\n') in = In::Code;
        blank(i);
        break;
      case In::Block:
        if (here == '*' && next == '/') {
          blank(i++);
          in = In::Code;
        }
        blank(i);
        break;
    }
  }
  return code;
}

Findings forbiddenIncludes(const Arrows& arrows, const std::string& file, std::string_view source) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  Findings findings;
  std::istringstream lines{withoutComments(source)};
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!std::regex_search(line, match, kInclude)) continue;
    const std::string fault = objection(arrows, file, match[1]);
    if (!fault.empty()) findings.push_back({number, fault});
  }
  return findings;
}

Findings forbiddenCalls(std::string_view source) {
  static const std::regex kCalls(
      R"(\brandom_device\b|\b(system|steady|high_resolution)_clock::now\b|\bstd::(cout|cerr|clog)\b)"
      R"(|\b(exit|_Exit|quick_exit|abort)\s*\(|\bs?rand\s*\(|\b(f|v|vf)?printf\s*\()");
  return matches(withoutComments(source), kCalls, "not in the library: ");
}

Findings sensorNames(std::string_view source) {
  static const std::regex kSensors(
      R"(\b(OdometryIncrement|WheelSpeeds|WheelTicks|ImuSample|BeaconRange|GnssFix|Scan2D|PassageFix)\b)");
  return matches(withoutComments(source), kSensors, "a filter names a sensor: ");
}

Findings machinePaths(std::string_view text) {
  static const std::regex kPaths(R"((^|[^A-Za-z0-9_.$}/~-])/(work|root|home|tmp)/)");
  return matches(text, kPaths, "path of one machine: ");
}

Findings brokenLinks(std::string_view markdown, const std::function<bool(const std::string&)>& exists) {
  static const std::regex kLink(R"(\]\(([^)\s]+)[^)]*\))");
  static const std::regex kOutside(R"(^([a-z]+:|#).*)");
  Findings findings;
  std::istringstream lines{std::string(markdown)};
  std::string line;
  bool fenced = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.rfind("```", 0) == 0) fenced = !fenced;
    if (fenced) continue;
    for (std::sregex_iterator match(line.begin(), line.end(), kLink), end; match != end; ++match) {
      const std::string link = (*match)[1];
      if (std::regex_match(link, kOutside)) continue;
      const std::string path = link.substr(0, link.find('#'));
      if (!exists(path)) findings.push_back({number, "broken link: " + link});
    }
  }
  return findings;
}

}  // namespace pos::structure
