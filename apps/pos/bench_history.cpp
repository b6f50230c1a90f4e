#include "bench_history.hpp"

#include <fstream>

#include "common.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"

namespace pos::app {

namespace fs = std::filesystem;

std::vector<RecordedRatio> readHistory(const fs::path& file) {
  io::CsvReader table(io::existingFile(file, Complaint{.key = "--history"}));
  const std::size_t date = table.column("date");
  const std::size_t processor = table.column("processor");
  const std::size_t compiler = table.column("compiler");
  const std::size_t pair = table.column("pair");
  const std::size_t ratio = table.column("ratio");
  std::vector<RecordedRatio> rows;
  while (table.next()) {
    rows.push_back({std::string(table.cell(date)), std::string(table.cell(processor)),
                    std::string(table.cell(compiler)), std::string(table.cell(pair)), table.number(ratio)});
    if (rows.back().ratio <= 0.0) table.refuse(ratio, "a ratio is not positive", "a number above 0");
  }
  return rows;
}

void appendHistory(const fs::path& file, const std::vector<RecordedRatio>& rows) {
  std::string text = io::fileText(file);
  for (const RecordedRatio& row : rows) {
    text += io::text::csvCell(row.date) + "," + io::text::csvCell(row.processor) + "," +
            io::text::csvCell(row.compiler) + "," + io::text::csvCell(row.pair) + "," +
            io::text::fixed(row.ratio, 3) + "\n";
  }
  writeFile(file, text);
}

std::vector<JudgedRatio> judged(const std::vector<bench::Ratio>& ratios,
                                const std::vector<RecordedRatio>& history, const std::string& processor) {
  std::vector<JudgedRatio> all;
  for (const bench::Ratio& ratio : ratios) {
    JudgedRatio one{ratio, std::nullopt};
    for (const RecordedRatio& row : history) {
      if (row.processor == processor && row.pair == ratio.pair) one.recorded = row.ratio;
    }
    one.worse = one.recorded && ratio.ratio < kLeastShare * *one.recorded;
    all.push_back(one);
  }
  return all;
}

std::string processorModel() {
  std::ifstream file("/proc/cpuinfo");
  std::string model;
  for (std::string line; std::getline(file, line) && !line.empty();) {  // an empty line ends a processor
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const auto key = io::text::trimmed(std::string_view(line).substr(0, colon));
    const std::string value(io::text::trimmed(std::string_view(line).substr(colon + 1)));
    if (key == "model name") model.insert(0, value);
    if (key == "cpu family") model += ", family " + value;
    if (key == "model") model += ", model " + value;
    if (key == "stepping") model += ", stepping " + value;
  }
  return model.empty() ? "unknown" : model;
}

}  // namespace pos::app
