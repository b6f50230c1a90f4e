/// performance_table <json files of the benchmark programs>: prints the machine and the tables as Markdown.
#include <fstream>
#include <iostream>
#include <iterator>

#include "performance_table.hpp"

int main(int argc, char** argv) {
  try {
    std::vector<nlohmann::json> runs;
    for (int i = 1; i < argc; ++i) {
      std::ifstream file(argv[i]);
      runs.push_back(pos::bench::parsed({std::istreambuf_iterator<char>(file), {}}));
    }
    const nlohmann::json run = pos::bench::joined(runs);
    std::cout << "Machine: " << pos::bench::machineLine(run) << ".\n\n"
              << pos::bench::tables(run, pos::bench::topics());
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "performance_table: " << error.what() << '\n';
    return 1;
  }
}
