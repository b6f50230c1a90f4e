#include "completion.hpp"

#include <algorithm>

namespace pos::app {
namespace {

/// As one word in single quotes; sh and zsh end the quotes for one inside, fish takes a backslash.
std::string inQuotes(const std::string& text, const char* inner = R"('\'')") {
  std::string result = "'";
  for (const char letter : text) letter == '\'' ? result += inner : result += letter;
  return result + "'";
}

std::string withBackslash(const std::string& text, const std::string& letters) {
  std::string result;
  for (const char letter : text) {
    if (letters.find(letter) != std::string::npos) result += '\\';
    result += letter;
  }
  return result;
}

std::string spaced(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : " ") + word;
  return result;
}

/// Numbers have no words to offer, and no file is one.
bool isNumber(const OptionShape& option) {
  return option.argument == "INT" || option.argument == "UINT" || option.argument == "FLOAT";
}

/// What may stand where a verb may: verbs, then the words of operands.
std::vector<std::string> wordsOf(const Command& command) {
  std::vector<std::string> words;
  for (const Command& verb : command.verbs) words.push_back(lastWord(verb.path));
  for (const OptionShape& operand : command.operands)
    words.insert(words.end(), operand.choices.begin(), operand.choices.end());
  return words;
}

std::vector<std::string> pathsOf(const Command& root) {
  std::vector<std::string> paths;
  for (const Command* command : flattened(root)) paths.push_back(command->path);
  return paths;
}

std::string patterns(const std::vector<std::string>& paths) {
  std::string result;
  for (const std::string& path : paths) result += (result.empty() ? "" : "|") + inQuotes(path);
  return result;
}

/// Options of one command for bash: all, those with an argument, those with a number.
std::string bashCase(const Command& command) {
  std::vector<std::string> all;
  std::vector<std::string> taking;
  std::vector<std::string> numbers;
  for (const OptionShape& option : command.options) {
    for (const std::string& name : option.names) {
      all.push_back(name);
      if (!option.argument.empty()) taking.push_back(name);
      if (isNumber(option)) numbers.push_back(name);
    }
  }
  const bool files = std::any_of(command.operands.begin(), command.operands.end(),
                                 [](const OptionShape& operand) { return operand.choices.empty(); });
  return "    " + inQuotes(command.path) + ")\n      words=" + inQuotes(spaced(wordsOf(command))) +
         " files=" + (files ? "yes" : "") + "\n      options=" + inQuotes(spaced(all)) +
         "\n      taking=" + inQuotes(spaced(taking)) + "\n      numbers=" + inQuotes(spaced(numbers)) +
         " ;;\n";
}

std::string bashValues(const Command& command) {
  std::string cases;
  for (const OptionShape& option : command.options) {
    if (option.choices.empty()) continue;
    cases += "    " + inQuotes(command.path + " " + option.names.back()) + ") echo " +
             inQuotes(spaced(option.choices)) + " ;;\n";
  }
  return cases;
}

constexpr const char* kBashBody = R"bash(
_pos() {
  local at=pos word=${COMP_WORDS[COMP_CWORD]} asked= words files options taking numbers i
  COMPREPLY=()
  _pos_tree "$at"
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ " $taking " == *" ${COMP_WORDS[i]} "* ]]; then
      asked=${COMP_WORDS[i]}
      [[ ${COMP_WORDS[i + 1]} != = ]] || ((++i))
      ((++i < COMP_CWORD)) && asked=
    elif _pos_tree "$at ${COMP_WORDS[i]}"; then
      at+=" ${COMP_WORDS[i]}"
    fi
  done
  [[ $word != = ]] || word=
  if [[ -n $asked ]]; then
    COMPREPLY=($(compgen -W "$(_pos_values "$at $asked")" -- "$word"))
    [[ " $numbers " != *" $asked "* ]] || compopt +o default 2>/dev/null
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  else
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    if [[ -z $files ]]; then
      compopt +o default 2>/dev/null
    elif [[ -n $words ]]; then
      COMPREPLY+=($(compgen -f -- "$word"))
    fi
  fi
  return 0
}
complete -o default -F _pos pos
)bash";

/// Inside '...[about]' and '(word\:"about")' of _arguments.
std::string zshText(const std::string& text) {
  return withBackslash(text, "\\[]:\"`$");
}

std::string zshOption(const OptionShape& option) {
  const std::string about = "[" + zshText(option.about) + "]";
  std::string action;
  if (!option.argument.empty()) {
    action = ":" + option.argument + ":";
    action += !option.choices.empty() ? "(" + spaced(option.choices) + ")"
              : isNumber(option)      ? " "
                                      : "_files";
  }
  std::string specs;
  for (const std::string& name : option.names) {
    const bool long_name = name.starts_with("--") && !option.argument.empty();
    std::string spec = option.repeated ? "*" : "";
    spec += name;
    spec += long_name ? "=" : "";
    spec += about;
    spec += action;
    specs += " \\\n        " + inQuotes(spec);
  }
  return specs;
}

std::string zshCase(const Command& command) {
  std::string text = "    (" + inQuotes(command.path) + ") _arguments -s :";
  for (const OptionShape& option : command.options) text += zshOption(option);
  if (!command.verbs.empty()) {
    std::string verbs;
    for (const Command& verb : command.verbs)
      verbs += " " + lastWord(verb.path) + "\\:\"" + zshText(verb.about) + "\"";
    text += " \\\n        " + inQuotes(": :((" + verbs.substr(1) + "))");
  }
  for (const OptionShape& operand : command.operands) {
    if (!command.verbs.empty()) break;
    const std::string what = operand.choices.empty() ? "_files" : "(" + spaced(operand.choices) + ")";
    text += " \\\n        " +
            inQuotes(std::string(operand.repeated ? "*" : "") + ":" + operand.names.front() + ":" + what);
  }
  return text + " ;;\n";
}

std::string fishQuoted(const std::string& text) {
  return inQuotes(withBackslash(text, "\\"), R"(\')");
}

std::string fishOption(const std::string& condition, const OptionShape& option) {
  std::string line = condition;
  for (const std::string& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.choices.empty()) {
    line += " -x -a " + fishQuoted(spaced(option.choices));
  } else if (!option.argument.empty()) {
    line += isNumber(option) ? " -x" : " -r -F";
  }
  return line + " -d " + fishQuoted(option.about) + "\n";
}

}  // namespace

std::string bashCompletion(const Command& root) {
  std::string tree;
  std::string values;
  for (const Command* command : flattened(root)) {
    tree += bashCase(*command);
    values += bashValues(*command);
  }
  return "# Completion of `pos` in bash; written by `pos completion bash`.\n\n"
         "# What may follow, into the variables of _pos; fails where there is no such verb.\n"
         "_pos_tree() {\n  case $1 in\n" +
         tree + "    *) return 1 ;;\n  esac\n}\n\n_pos_values() {\n  case $1 in\n" + values + "  esac\n}\n" +
         kBashBody;
}

std::string zshCompletion(const Command& root) {
  std::string cases;
  for (const Command* command : flattened(root)) cases += zshCase(*command);
  return "#compdef pos\n# Completion of `pos` in zsh; written by `pos completion zsh`.\n\n"
         "_pos() {\n  local at=pos depth=1 i\n"
         "  for ((i = 2; i < CURRENT; i++)); do\n    case \"$at ${words[i]}\" in\n      (" +
         patterns(pathsOf(root)) +
         ") at=\"$at ${words[i]}\" depth=$i ;;\n    esac\n  done\n"
         "  words=(pos \"${(@)words[depth + 1, -1]}\")\n  (( CURRENT -= depth - 1 ))\n"
         "  case $at in\n" +
         cases + "  esac\n}\n\n_pos \"$@\"\n";
}

std::string fishCompletion(const Command& root) {
  std::string paths;
  for (const std::string& path : pathsOf(root)) paths += " " + fishQuoted(path);
  std::string text =
      "# Completion of `pos` in fish; written by `pos completion fish`.\n\n"
      "# True where the verbs typed so far are these.\n"
      "function __pos_at\n  set -l at pos\n  for word in (commandline -opc)[2..-1]\n"
      "    contains -- \"$at $word\"" +
      paths + "\n    and set at \"$at $word\"\n  end\n  test \"$at\" = \"$argv[1]\"\nend\n\n";
  for (const Command* command : flattened(root)) {
    const std::string condition = "complete -c pos -n \"__pos_at '" + command->path + "'\"";
    for (const Command& verb : command->verbs)
      text += condition + " -f -a " + lastWord(verb.path) + " -d " + fishQuoted(verb.about) + "\n";
    for (const OptionShape& operand : command->operands) {
      if (!operand.choices.empty())
        text += condition + " -f -a " + fishQuoted(spaced(operand.choices)) + "\n";
    }
    for (const OptionShape& option : command->options) text += fishOption(condition, option);
  }
  return text;
}

}  // namespace pos::app
