#pragma once
/// The checks that every `validated(config)` is made of. Each throws ConfigError that names the key; keys are
/// as in the file, units and all where the struct knows them.
///
/// `unit` stands behind what was expected; `owner` is whose value it is ("roadway r1"), for lists whose keys
/// tell only a number. Both may be empty.

#include <string>
#include <utility>

#include "pos/core/error.hpp"

namespace pos {

/// "table.key"; one of them alone where the other is empty.
std::string prefixed(const std::string& table, const std::string& key);
/// "list[index]".
std::string indexed(const std::string& list, std::size_t index);

[[noreturn]] void refuse(const std::string& what, const std::string& key, const std::string& got,
                         const std::string& expected, const std::string& suggestion = {});

void requireFinite(double value, const std::string& key, const std::string& unit = {},
                   const std::string& owner = {});
/// Above zero and finite.
void requirePositive(double value, const std::string& key, const std::string& unit = {},
                     const std::string& owner = {});
/// Zero or more, and finite.
void requireNotNegative(double value, const std::string& key, const std::string& unit = {},
                        const std::string& owner = {});
/// Between 0 and 1, both allowed: a share or a probability.
void requireShare(double value, const std::string& key);
/// Between 0 and 1, neither allowed: a confidence.
void requireConfidence(double value, const std::string& key);
/// Anything else: `holds`, or a complaint that says what was expected.
void require(bool holds, const std::string& key, const std::string& expected,
             const std::string& what = "this cannot be");

/// What `rule` returns; a complaint of it gets `table` in front of its key.
template <class Rule>
auto under(const std::string& table, Rule&& rule) {
  try {
    return std::forward<Rule>(rule)();
  } catch (const ConfigError& error) {
    Complaint complaint = error.complaint();
    complaint.key = prefixed(table, complaint.key);
    throw ConfigError(complaint);
  }
}

/// `validated` on a struct inside another one, so that a complaint names the whole key. It is looked up in
/// the struct's own namespace.
template <class Inner>
void requireValid(const Inner& inner, const std::string& table) {
  under(table, [&] { (void)validated(inner); });
}

}  // namespace pos
