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

void addRange(const Range& range, YamlNode* schema) {
  if (std::isfinite(range.min)) {
    schema->add(range.min_excluded ? "exclusiveMinimum" : "minimum", plainNode(numberText(range.min, "")));
  }
  if (std::isfinite(range.max)) {
    schema->add(range.max_excluded ? "exclusiveMaximum" : "maximum", plainNode(numberText(range.max, "")));
  }
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
  if (number) addRange(option.range, &schema);
  if (option.kind == Option::Kind::Choice) schema.add("enum", textList(option.choices));
  if (option.kind == Option::Kind::Text || option.kind == Option::Kind::Path)
    schema.add("minLength", plainNode("1"));
  const auto value = row.write && !option.required ? row.write(defaults, Comments::None) : std::nullopt;
  if (value) schema.add("default", *value);
  return schema;
}

YamlNode rowSchema(const OptionRow& row, const void* defaults) {
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

void addRows(const TableCore& table, const void* defaults, YamlNode* properties, YamlNode* required) {
  for (const OptionRow& row : table.rows) {
    if (row.option.required) required->items.push_back(textNode(row.option.key));
    if (properties->find(row.option.key) == nullptr)
      properties->add(row.option.key, rowSchema(row, defaults));
  }
}

YamlNode objectSchema(YamlNode properties, YamlNode required) {
  YamlNode schema = tableNode();
  schema.add("type", textNode("object"));
  schema.add("properties", std::move(properties));
  if (!required.items.empty()) schema.add("required", std::move(required));
  schema.add("additionalProperties", plainNode("false"));
  return schema;
}

YamlNode alternativeSchema(const TableCore& table, const void* defaults, const Alternative& alternative) {
  YamlNode constant = tableNode();
  constant.add("const", textNode(alternative.name));
  constant.add("description", textNode(alternative.text));
  YamlNode properties = tableNode();
  YamlNode required = listNode();
  properties.add(table.selector, std::move(constant));
  addRows(table, defaults, &properties, &required);
  const auto sample = alternative.sample();
  addRows(*alternative.table, sample.get(), &properties, &required);
  return objectSchema(std::move(properties), std::move(required));
}

YamlNode tableSchema(const TableCore& table, const void* defaults) {
  YamlNode properties = tableNode();
  YamlNode required = listNode();
  if (table.alternatives.empty()) {
    addRows(table, defaults, &properties, &required);
    return objectSchema(std::move(properties), std::move(required));
  }
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
