/// `pos version`.

#include "common.hpp"

namespace pos::app {

void addVersion(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("version", "Print version and source revision");
  verb->callback([] { print("pos " + version() + " (" + gitHash() + ")\n"); });
}

}  // namespace pos::app
