#pragma once
/// JSON text as the same tree that YAML is read into, with places; numbers keep their digits. Internal to io.

#include <filesystem>
#include <string>

#include "pos/io/yaml_document.hpp"

namespace pos::io {

/// Stricter than JSON: names given twice and nesting deeper than 32 are refused. Throws ConfigError with line
/// and column.
YamlDocument parseJson(const std::string& text, const std::filesystem::path& file);

/// A tree on one line. Plain scalars that are numbers, true or false are written bare, all others in quotes.
std::string compactJson(const YamlNode& node);

}  // namespace pos::io
