#include "pos/io/option_core.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

const Alternative* heldAlternative(const TableCore& table, const void* object) {
  for (const Alternative& alternative : table.alternatives) {
    if (alternative.held(object) != nullptr) return &alternative;
  }
  return nullptr;
}

std::string explanation(const Option& option) {
  const bool leaf = option.kind != Option::Kind::Table && option.kind != Option::Kind::List;
  return leaf ? option.text + " (" + expectedText(option) + ")" : option.text;
}

/// Adds the rows that have a value; returns the keys of the others.
std::string writeRows(const TableCore& table, const void* object, Comments comments, YamlNode* node) {
  std::string absent;
  for (const OptionRow& row : table.rows) {
    std::optional<YamlNode> value;
    if (row.option.key == table.selector) {
      if (const Alternative* held = heldAlternative(table, object)) value = textNode(held->name);
    } else {
      value = row.write(object, comments);
    }
    if (!value) {
      absent += (absent.empty() ? "" : ", ") + row.option.key;
      continue;
    }
    if (comments == Comments::Explained) {
      value->comment = explanation(row.option) + (value->comment.empty() ? "" : "\n" + value->comment);
    }
    node->add(row.option.key, std::move(*value));
  }
  return absent;
}

// ---- reference -------------------------------------------------------------------------------------------

std::string kindName(const Option& option) {
  switch (option.kind) {
    case Option::Kind::Number:
      return "number";
    case Option::Kind::Integer:
      return "whole number";
    case Option::Kind::Text:
      return "text";
    case Option::Kind::Choice:
      return "choice";
    case Option::Kind::Flag:
      return "true/false";
    case Option::Kind::Path:
      return "path";
    case Option::Kind::Table:
      return "table";
    case Option::Kind::List:
      return "list";
  }
  return "";
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

std::string allowed(const Option& option) {
  std::string text;
  for (const std::string& choice : option.choices) text += (text.empty() ? "" : ", ") + code(choice);
  return text.empty() ? rangeText(option.range) : text;
}

std::string defaultText(const OptionRow& row, const void* defaults) {
  if (row.option.required) return "required";
  if (row.option.kind == Option::Kind::Table) return row.option.optional ? "absent" : "";
  const auto value = row.write ? row.write(defaults, Comments::None) : std::nullopt;
  return value ? code(inlineText(*value)) : "absent";
}

std::string referenceRows(const TableCore& table, const void* defaults, const std::string& prefix) {
  std::string text;
  for (const OptionRow& row : table.rows) {
    const Option& option = row.option;
    const std::string key = prefix + option.key;
    text += "| " + code(key) + " | " + kindName(option) + " | " + std::string(unitOf(option.key).symbol) +
            " | " + allowed(option) + " | " + defaultText(row, defaults) + " | " + option.text + " |\n";
    if (row.table) {
      const auto sample = row.sample(defaults);
      text +=
          referenceRows(*row.table, sample.get(), key + (option.kind == Option::Kind::List ? "[]." : "."));
    }
  }
  return text;
}

constexpr const char* kHead =
    "| key | type | unit | allowed | default | meaning |\n| --- | --- | --- | --- | --- | --- |\n";

/// A section for each alternative found in the table or below it.
std::string alternativeSections(const TableCore& table) {
  std::string text;
  for (const Alternative& alternative : table.alternatives) {
    const auto sample = alternative.sample();
    text += "\n## " + code(table.selector + ": " + alternative.name) + "\n\n" + alternative.text + "\n\n" +
            kHead + referenceRows(*alternative.table, sample.get(), "");
  }
  for (const OptionRow& row : table.rows) {
    if (row.table) text += alternativeSections(*row.table);
  }
  return text;
}

}  // namespace

YamlNode writeTable(const TableCore& table, const void* object, Comments comments) {
  YamlNode node = tableNode();
  std::string absent = writeRows(table, object, comments, &node);
  if (const Alternative* held = heldAlternative(table, object)) {
    const std::string more = writeRows(*held->table, held->held(object), comments, &node);
    absent += (absent.empty() || more.empty() ? "" : ", ") + more;
  }
  if (comments == Comments::Explained && !absent.empty())
    node.comment = "Further keys, not set here: " + absent;
  return node;
}

std::string markdownReference(const TableCore& table, const void* defaults) {
  return "# " + table.title + "\n\n" + table.text + "\n\n" + kHead + referenceRows(table, defaults, "") +
         alternativeSections(table);
}

}  // namespace pos::io
