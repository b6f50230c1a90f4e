#include "pos/io/files.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <system_error>

#include "pos/core/edit_distance.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

std::string lowered(const std::string& word) {
  std::string low = word;
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return low;
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

[[noreturn]] void refuseMissing(const fs::path& file, Complaint complaint) {
  const fs::path folder = folderOf(file);
  std::error_code failure;
  complaint.what = "the file does not exist";
  complaint.got = file.string();
  if (!fs::is_directory(folder, failure)) {
    complaint.expected = "a file; there is no folder " + folder.string() + " either";
    throw ConfigError(complaint);
  }
  complaint.expected = "a file in the folder " + folder.string();
  const auto near = nearestName(file.filename().string(), namesIn(folder));
  complaint.suggestion = near ? "did you mean " + *near + "?" : "check the path";
  throw ConfigError(complaint);
}

}  // namespace

std::optional<std::string> nearestName(const std::string& word, const std::vector<std::string>& candidates) {
  const std::size_t limit = std::max<std::size_t>(1, std::min<std::size_t>(word.size(), 12) / 3);
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) >= best_distance) continue;
    const std::size_t distance = editDistance(lowered(word), lowered(candidate));
    if (distance < best_distance && distance < longer) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

fs::path existingFile(const fs::path& file, const Complaint& context) {
  Complaint complaint = context;
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (fs::is_directory(status)) {
    complaint.what = "this is a folder, not a file";
    complaint.got = file.string();
    complaint.expected = "a file";
    throw ConfigError(complaint);
  }
  if (!fs::exists(status)) refuseMissing(file, complaint);
  if (!std::ifstream(file)) {
    complaint.what = "the file cannot be read";
    complaint.got = file.string();
    complaint.suggestion = "check its permissions";
    throw ConfigError(complaint);
  }
  return file;
}

std::string fileText(const fs::path& file) {
  std::ifstream stream(existingFile(file), std::ios::binary);
  std::ostringstream text;
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  if (stream.bad() || text.bad()) {
    throw ConfigError(Complaint{.what = "the file cannot be read to its end", .got = file.string()});
  }
  return text.str();
}

fs::path resolvedPath(const fs::path& path, const fs::path& folder, const fs::path& mrpt_share) {
  const std::string prefix = "mrpt-common:";
  const std::string text = path.string();
  if (text.starts_with(prefix))
    return fs::absolute(mrpt_share / text.substr(prefix.size())).lexically_normal();
  return fs::absolute(path.is_absolute() ? path : folder / path).lexically_normal();
}

}  // namespace pos::io
