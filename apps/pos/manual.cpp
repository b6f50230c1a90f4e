#include "manual.hpp"

#include <algorithm>
#include <array>

namespace pos::app {
namespace {

/// Plain text for troff: no dash becomes a hyphen, no backslash an escape, no line a request.
std::string plain(const std::string& text) {
  std::string result;
  bool line_start = true;
  for (const char letter : text) {
    if (line_start && (letter == '.' || letter == '\'')) result += "\\&";
    if (letter == '-') {
      result += "\\-";
    } else if (letter == '\\') {
      result += "\\e";
    } else {
      result += letter;
    }
    line_start = letter == '\n';
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

std::string slanted(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

bool isCommon(const OptionShape& option) {
  static constexpr std::array kCommon{"--help", "--quiet", "--verbose"};
  return std::find(kCommon.begin(), kCommon.end(), option.names.back()) != kCommon.end();
}

std::string argumentOf(const OptionShape& option) {
  if (option.choices.empty()) return slanted(option.argument);
  std::string words;
  for (const std::string& word : option.choices) words += (words.empty() ? "" : "|") + bold(word);
  return words;
}

std::string paragraph(const OptionShape& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
  if (!option.argument.empty()) names += " " + argumentOf(option);
  return ".TP\n" + names + "\n" + plain(option.about) + (option.required ? " (required)" : "") + ".\n";
}

std::string synopsis(const Command& command) {
  std::string line = bold(command.path) + " [" + slanted("options") + "]";
  for (const OptionShape& operand : command.operands) {
    const std::string words = operand.choices.empty() ? slanted(operand.names.front()) : argumentOf(operand);
    line += " " + (operand.required ? words : "[" + words + "]") + (operand.repeated ? "..." : "");
  }
  return line + "\n";
}

/// One verb: what it does, what it works on, its options.
std::string section(const Command& command) {
  std::string text =
      ".SS " + plain(command.path) + "\n" + plain(command.about) + ".\n.PP\n" + synopsis(command);
  for (const OptionShape& operand : command.operands)
    text += ".TP\n" + slanted(operand.names.front()) + "\n" + plain(operand.about) + ".\n";
  for (const OptionShape& option : command.options) {
    if (!isCommon(option)) text += paragraph(option);
  }
  if (!command.footer.empty()) text += ".PP\n" + plain(command.footer) + "\n";
  return text;
}

constexpr const char* kEnd = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
A fault of pos itself.
.TP
.B 2
The command line asks for something that cannot be.
.TP
.B 3
A configuration, mapping or map is wrong.
.TP
.B 4
A \-\-require or a target was missed, or a benchmark got slower.
.TP
.B 5
A log, trajectory or table is missing, damaged or too short.
.TP
.B 130
Interrupted; the results cover the log up to there.
.SH ENVIRONMENT
.TP
.B POS_MRPT_SHARE
Folder that \(lqmrpt\-common:\(rq in paths stands for; default
.IR /usr/share/mrpt .
.SH SEE ALSO
.BR "pos VERB \-\-help" ;
the configurations and maps in the folder
.I share/pos
beside the program.
)";

}  // namespace

std::string manualPage(const Command& root, const std::string& version) {
  std::string text =
      ".\\\" Written by `pos man`.\n.TH POS 1 \"\" \"pos " + version +
      "\" \"User Commands\"\n.SH NAME\npos \\- positioning for vehicles under ground\n.SH SYNOPSIS\n"
      ".B pos\n.I VERB\n[\\fIoptions\\fR]\n.SH DESCRIPTION\n" +
      plain(root.about) +
      "\n.PP\nStandard output carries only what was asked for; notes, progress and errors go to "
      "standard error.\n.SH OPTIONS\n";
  for (const OptionShape& option : root.options) text += paragraph(option);
  const auto all = flattened(root);
  for (const char* name : {"--quiet", "--verbose"}) {
    for (const Command* command : all) {
      const auto found = std::find_if(command->options.begin(), command->options.end(),
                                      [&](const OptionShape& option) { return option.names.back() == name; });
      if (found == command->options.end()) continue;
      text += paragraph(*found);
      break;
    }
  }
  text += ".SH VERBS\n";
  for (const Command* command : all) {
    if (command != &root && !command->verb_required) text += section(*command);
  }
  return text + kEnd;
}

}  // namespace pos::app
