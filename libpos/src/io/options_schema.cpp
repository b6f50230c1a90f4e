#include <cmath>

#include "pos/io/option_core.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

YamlNode tableSchema(const TableCore& table, const void* defaults);

YamlNode textList(const std::vector<std::string>& texts) {
  YamlNode list = listNode();
  for (const std::string& text : texts) list.items.push_back(textNode(text));
  return list;
}

YamlNode withRange(YamlNode schema, const Range& range) {
  if (std::isfinite(range.min)) {
    schema.add(range.min_excluded ? "exclusiveMinimum" : "minimum", plainNode(numberText(range.min, "")));
  }
  if (std::isfinite(range.max)) {
    schema.add(range.max_excluded ? "exclusiveMaximum" : "maximum", plainNode(numberText(range.max, "")));
  }
  return schema;
}

YamlNode numbersSchema(const Option& option) {
  YamlNode item = tableNode();
  item.add("type", textNode("number"));
  YamlNode schema = tableNode();
  schema.add("type", textNode("array"));
  const std::string unit(unitOf(option.key).symbol);
  schema.add("description", textNode(option.text + (unit.empty() ? "" : " Unit: " + unit + ".")));
  schema.add("items", withRange(std::move(item), option.range));
  if (option.count > 0) {
    schema.add("minItems", plainNode(std::to_string(option.count)));
    schema.add("maxItems", plainNode(std::to_string(option.count)));
  }
  return schema;
}

YamlNode leafSchema(const OptionRow& row, const void* defaults) {
  const Option& option = row.option;
  YamlNode schema = tableNode();
  const bool number = option.kind == Option::Kind::Number || option.kind == Option::Kind::Integer;
  const char* type = option.kind == Option::Kind::Number    ? "number"
                     : option.kind == Option::Kind::Integer ? "integer"
                     : option.kind == Option::Kind::Flag    ? "boolean"
                                                            : "string";
  const std::string unit(unitOf(option.key).symbol);
  schema.add("type", textNode(type));
  schema.add("description", textNode(option.text + (unit.empty() ? "" : " Unit: " + unit + ".")));
  if (number) schema = withRange(std::move(schema), option.range);
  if (option.kind == Option::Kind::Choice) schema.add("enum", textList(option.choices));
  if (option.kind == Option::Kind::Text || option.kind == Option::Kind::Path)
    schema.add("minLength", plainNode("1"));
  const auto value = row.write && !option.required ? row.write(defaults, Comments::None) : std::nullopt;
  if (value) schema.add("default", *value);
  return schema;
}

YamlNode rowSchema(const OptionRow& row, const void* defaults) {
  if (row.option.kind == Option::Kind::Numbers) return numbersSchema(row.option);
  if (!row.table) return leafSchema(row, defaults);
  const auto sample = row.sample(defaults);
  YamlNode inner = tableSchema(*row.table, sample.get());
  if (row.option.kind == Option::Kind::Table) {
    inner.add("description", textNode(row.option.text));
    return inner;
  }
  YamlNode list = tableNode();
  list.add("type", textNode("array"));
  list.add("description", textNode(row.option.text));
  list.add("items", std::move(inner));
  return list;
}

/// A table's schema while it is put together.
struct ObjectParts {
  YamlNode properties = tableNode();
  YamlNode required = listNode();
};

ObjectParts withRows(ObjectParts parts, const TableCore& table, const void* defaults) {
  for (const OptionRow& row : table.rows) {
    const std::string& key = row.option.key;
    if (row.option.required) parts.required.items.push_back(textNode(key));
    if (parts.properties.find(key) == nullptr) parts.properties.add(key, rowSchema(row, defaults));
  }
  return parts;
}

YamlNode objectSchema(ObjectParts parts) {
  YamlNode schema = tableNode();
  schema.add("type", textNode("object"));
  schema.add("properties", std::move(parts.properties));
  if (!parts.required.items.empty()) schema.add("required", std::move(parts.required));
  schema.add("additionalProperties", plainNode("false"));
  return schema;
}

YamlNode alternativeSchema(const TableCore& table, const void* defaults, const Alternative& alternative) {
  YamlNode name = tableNode();
  name.add("const", textNode(alternative.name));
  name.add("description", textNode(alternative.text));
  ObjectParts parts;
  parts.properties.add(table.selector, std::move(name));
  parts = withRows(std::move(parts), table, defaults);
  const auto sample = alternative.sample();
  return objectSchema(withRows(std::move(parts), *alternative.table, sample.get()));
}

YamlNode tableSchema(const TableCore& table, const void* defaults) {
  if (table.alternatives.empty()) return objectSchema(withRows({}, table, defaults));
  YamlNode any = listNode();
  for (const Alternative& alternative : table.alternatives) {
    any.items.push_back(alternativeSchema(table, defaults, alternative));
  }
  YamlNode schema = tableNode();
  schema.add("oneOf", std::move(any));
  return schema;
}

}  // namespace

std::string jsonSchema(const TableCore& table, const void* defaults) {
  YamlNode schema = tableNode();
  schema.add("$schema", textNode("https://json-schema.org/draft/2020-12/schema"));
  schema.add("title", textNode(table.title));
  schema.add("description", textNode(table.text));
  YamlNode body = tableSchema(table, defaults);
  for (std::size_t i = 0; i < body.keys.size(); ++i) schema.add(body.keys[i].name, std::move(body.items[i]));
  return jsonText(schema);
}

}  // namespace pos::io
