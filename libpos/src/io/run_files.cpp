#include "run_files.hpp"

#include <algorithm>

#include "pos/core/error.hpp"

namespace pos::io {

namespace fs = std::filesystem;

std::vector<std::string> estimatorsOf(const fs::path& folder) {
  std::vector<std::string> names;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      fs::path csv = entry.path();
      if (csv.extension() == ".tum" && fs::exists(csv.replace_extension(".csv")))
        names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  if (!names.empty()) return names;
  throw DataError(Complaint{.what = "this is no folder of a run",
                            .place = {.file = folder.string()},
                            .expected = "run.json, and for each estimator <name>.tum and <name>.csv",
                            .suggestion = "make one with pos replay --out"});
}

}  // namespace pos::io
