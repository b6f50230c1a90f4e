#pragma once
/// The map editor's half on the server: the library judges, the one map file is read and replaced.

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "pos/serve/request.hpp"

namespace pos::serve {

/// Bodies are maps as GeoJSON text. All throw RequestError (422 invalid_map for what is no map) and answer
/// with JSON text.
class MapService {
 public:
  enum class Access { ReadOnly, Editable };
  MapService(std::filesystem::path file, Access access) : file_(std::move(file)), access_(access) {}

  struct Version {
    std::string geojson = {};
    std::string version = {};  ///< entity tag, quotes included
  };
  /// The file as it is now.
  Version saved() const;
  bool editable() const { return access_ == Access::Editable; }
  const std::filesystem::path& file() const { return file_; }

  std::string check(const std::string& body) const;
  /// Parameters: roadway, step_m, range_sigma_m, range_limit_m, tag_height_m.
  std::string coverage(const std::string& body, const Target& target) const;
  std::string diff(const std::string& body) const;
  std::string intervals(const std::string& body) const;
  /// Replaces the file when it still has the version that the editor started from; returns the new one.
  std::string save(const std::string& body, const std::string& if_match);

 private:
  std::filesystem::path file_;
  Access access_;
  mutable std::mutex mutex_;  // one save at a time
};

}  // namespace pos::serve
