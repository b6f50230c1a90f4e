#pragma once
/// One line of text that travels in a comment just before an observation and holds what MRPT's class has no
/// room for: `pos 1 <kind> key=value key=value`. Format: docs/formats/rawlog.md. Private to io.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pos::io {

class Companion {
 public:
  /// `kind` is the reading's name ("odometry", "imu", ...).
  explicit Companion(std::string kind) : kind_(std::move(kind)) {}
  /// Nothing when the text is no companion line of this version.
  static std::optional<Companion> fromText(std::string_view text);
  std::string text() const;

  const std::string& kind() const { return kind_; }
  bool empty() const { return fields_.empty(); }

  /// Written so that reading gives back exactly the same number.
  void put(const std::string& key, double value) { put(key, std::vector<double>{value}); }
  void put(const std::string& key, const std::vector<double>& values);
  void putInteger(const std::string& key, std::int64_t value);
  void putWord(const std::string& key, std::string_view word);

  /// Nothing when the key is absent or its value is not what is asked for.
  std::optional<double> number(std::string_view key) const;
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  std::optional<std::int64_t> integer(std::string_view key) const;
  std::optional<std::string> word(std::string_view key) const;

 private:
  std::string kind_;
  std::map<std::string, std::string, std::less<>> fields_;
};

}  // namespace pos::io
