/// `pos completion` and `pos man`: what shells and manual know of the command, from its own options.

#include <memory>

#include "common.hpp"
#include "completion.hpp"
#include "manual.hpp"

namespace pos::app {
namespace {

/// "TEXT:{tum,euroc}" is a type with its choices, "INT:INT in [0 - 65535]" one with a limit.
OptionShape shape(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  OptionShape result{.about = option.get_description(),
                     .required = option.get_required(),
                     .repeated = option.get_expected_max() > 1};
  if (option.get_positional()) result.names.push_back(option.get_name());
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) result.argument = type.substr(0, type.find(':'));
  const std::size_t open = type.find(":{");
  if (open == std::string::npos) return result;
  result.choices = CLI::detail::split(type.substr(open + 2, type.find('}', open) - open - 2), ',');
  return result;
}

Command tree(const CLI::App& app, const std::string& path) {
  Command command{.path = path,
                  .about = app.get_description(),
                  .footer = app.get_footer(),
                  .verb_required = app.get_require_subcommand_min() > 0};
  for (const CLI::Option* option : app.get_options())
    (option->get_positional() ? command.operands : command.options).push_back(shape(*option));
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    command.verbs.push_back(tree(*verb, path + " " + verb->get_name()));
  return command;
}

void write(const std::string& file, const std::string& text) {
  file.empty() ? print(text) : writeFile(file, text);
}

}  // namespace

void addCompletion(const Verbs& verbs) {
  CLI::App* verb =
      verbs.app->add_subcommand("completion", "Write the completion of the command line for a shell");
  auto shell = std::make_shared<std::string>();
  auto file = std::make_shared<std::string>();
  verb->add_option("shell", *shell, "The shell: bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->add_option("--out", *file, "File to write, instead of standard output");
  verb->callback([app = verbs.app, shell, file] {
    const Command root = tree(*app, app->get_name());
    write(*file, *shell == "bash"  ? bashCompletion(root)
                 : *shell == "zsh" ? zshCompletion(root)
                                   : fishCompletion(root));
  });
}

void addMan(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("man", "Write the manual page pos(1)");
  auto file = std::make_shared<std::string>();
  verb->add_option("--out", *file, "File to write, instead of standard output");
  verb->callback(
      [app = verbs.app, file] { write(*file, manualPage(tree(*app, app->get_name()), version())); });
}

}  // namespace pos::app
