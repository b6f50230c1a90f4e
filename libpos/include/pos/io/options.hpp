#pragma once
/// One declarative table per struct binds YAML keys to members. From the table come the strict reader, the
/// writer, the reference in Markdown, the JSON Schema and a commented example, so they cannot disagree.
///
///   OptionTable<RangeLikelihood>("range", "How good a range is.")
///       .number("sigma_m", &RangeLikelihood::sigma, moreThan(0.0), "Standard deviation of a good range.")
///       .flag("use", &RangeLikelihood::use, "Whether ranges are used.");
///
/// Members of type std::optional may be absent; every other key takes its default from a default-constructed
/// struct unless `.required()` follows it. A key's unit is its ending (units.hpp); numbers arrive in SI.
/// A member may be named by a member pointer or by a function object `[](auto& s) -> auto& { return s.p.x;
/// }`.

#include <algorithm>
#include <concepts>
#include <filesystem>
#include <type_traits>
#include <utility>
#include <variant>

#include "pos/io/option_core.hpp"

namespace pos::io {

namespace detail {

template <class M>
struct Slot {
  using Value = M;
  static constexpr bool kOptional = false;
  static const M* held(const M& member) { return &member; }
  static M& filled(M& member) { return member; }
};
template <class M>
struct Slot<std::optional<M>> {
  using Value = M;
  static constexpr bool kOptional = true;
  static const M* held(const std::optional<M>& member) { return member ? &*member : nullptr; }
  static M& filled(std::optional<M>& member) { return member.emplace(); }
};
template <class T, class Member>
using SlotOf = Slot<std::remove_cvref_t<std::invoke_result_t<Member, T&>>>;
template <class T, class Member>
using ValueOf = typename SlotOf<T, Member>::Value;

template <std::integral I>
I readWhole(const Field& field) {
  using Limits = std::numeric_limits<I>;
  if constexpr (std::is_unsigned_v<I>) return static_cast<I>(readUnsigned(field, Limits::max()));
  return static_cast<I>(
      readInteger(field, static_cast<std::int64_t>(Limits::min()),
                  static_cast<std::int64_t>(std::min<std::uintmax_t>(
                      static_cast<std::uintmax_t>(Limits::max()),
                      static_cast<std::uintmax_t>(std::numeric_limits<std::int64_t>::max())))));
}

YamlNode writtenNumber(double value, const std::string& key);

/// Numbers of a fixed count live in an Eigen vector, of any count in a std::vector. Other types that are
/// written as a few numbers specialise it.
template <class V>
struct NumberList {
  static constexpr std::size_t kCount = static_cast<std::size_t>(V::SizeAtCompileTime);
  static V of(const std::vector<double>& values) { return V(values.data()); }
  static std::vector<double> values(const V& list) { return {list.data(), list.data() + list.size()}; }
};
template <>
struct NumberList<std::vector<double>> {
  static constexpr std::size_t kCount = 0;
  static std::vector<double> of(const std::vector<double>& values) { return values; }
  static std::vector<double> values(const std::vector<double>& list) { return list; }
};
std::optional<YamlNode> writtenText(const std::string& value);

}  // namespace detail

/// A name in the file for each value of an enumeration.
template <class E>
struct NamedValue {
  std::string name;
  E value;
};

template <class T>
class OptionTable {
 public:
  OptionTable(std::string title, std::string text) : core_(std::make_shared<TableCore>()) {
    core_->title = std::move(title);
    core_->text = std::move(text);
  }

  /// A double. `range` is in the unit of the key.
  template <class Member>
  OptionTable& number(std::string key, Member member, Range range, std::string text) {
    return leaf({.kind = Option::Kind::Number, .key = key, .text = std::move(text), .range = range}, member,
                readNumber, [key](double value) { return detail::writtenNumber(value, key); });
  }

  /// [1, 2, 3]: as many as an Eigen vector holds, or any number of them for a std::vector.
  template <class Member>
  OptionTable& numbers(std::string key, Member member, Range range, std::string text) {
    using Values = detail::ValueOf<T, Member>;
    using List = detail::NumberList<Values>;
    return leaf(
        {.kind = Option::Kind::Numbers,
         .key = key,
         .text = std::move(text),
         .range = range,
         .count = List::kCount},
        member, [](const Field& field) { return List::of(readNumbers(field)); },
        [key](const Values& values) {
          YamlNode list = listNode();
          for (const double value : List::values(values))
            list.items.push_back(detail::writtenNumber(value, key));
          return list;
        });
  }

  template <class Member>
  OptionTable& integer(std::string key, Member member, Range range, std::string text) {
    using Whole = detail::ValueOf<T, Member>;
    return leaf(
        {.kind = Option::Kind::Integer, .key = std::move(key), .text = std::move(text), .range = range},
        member, detail::readWhole<Whole>, [](Whole value) { return plainNode(std::to_string(value)); });
  }

  /// Text that is not empty.
  template <class Member>
  OptionTable& text(std::string key, Member member, std::string text) {
    return leaf({.kind = Option::Kind::Text, .key = std::move(key), .text = std::move(text)}, member,
                readText, detail::writtenText);
  }

  /// A path as written; the owner of the table resolves it.
  template <class Member>
  OptionTable& path(std::string key, Member member, std::string text) {
    return leaf({.kind = Option::Kind::Path, .key = std::move(key), .text = std::move(text)}, member,
                readText,
                [](const std::filesystem::path& value) { return detail::writtenText(value.string()); });
  }

  template <class Member>
  OptionTable& flag(std::string key, Member member, std::string text) {
    return leaf({.kind = Option::Kind::Flag, .key = std::move(key), .text = std::move(text)}, member,
                readFlag, [](bool value) { return plainNode(value ? "true" : "false"); });
  }

  template <class Member>
  OptionTable& choice(std::string key, Member member,
                      std::vector<NamedValue<detail::ValueOf<T, Member>>> names, std::string text) {
    using E = detail::ValueOf<T, Member>;
    Option option{.kind = Option::Kind::Choice, .key = std::move(key), .text = std::move(text)};
    for (const auto& named : names) option.choices.push_back(named.name);
    return leaf(
        std::move(option), member, [names](const Field& field) { return names[readChoice(field)].value; },
        [names](E value) -> std::optional<YamlNode> {
          for (const auto& named : names) {
            if (named.value == value) return textNode(named.name);
          }
          return std::nullopt;
        });
  }

  template <class Member, class U>
  OptionTable& table(std::string key, Member member, const OptionTable<U>& inner, std::string text) {
    using Slot = detail::SlotOf<T, Member>;
    OptionRow row = nested<Slot>(Option::Kind::Table, std::move(key), std::move(text), inner.core());
    row.read = [member, core = inner.core()](void* object, const Field& field) {
      readTable(field.node, *core, &Slot::filled(std::invoke(member, *static_cast<T*>(object))), field.path);
    };
    row.sample = [member](const void* object) -> std::shared_ptr<const void> {
      const U* value = Slot::held(std::invoke(member, *static_cast<const T*>(object)));
      if (value == nullptr) return std::make_shared<const U>();
      return {std::shared_ptr<const void>{}, value};
    };
    row.write = [member, core = inner.core()](const void* object,
                                              Comments comments) -> std::optional<YamlNode> {
      const U* value = Slot::held(std::invoke(member, *static_cast<const T*>(object)));
      return value ? std::optional(writeTable(*core, value, comments)) : std::nullopt;
    };
    core_->rows.push_back(std::move(row));
    return *this;
  }

  /// A std::vector of structs.
  template <class Member, class U>
  OptionTable& list(std::string key, Member member, const OptionTable<U>& inner, std::string text) {
    using Slot = detail::SlotOf<T, Member>;
    OptionRow row = nested<Slot>(Option::Kind::List, std::move(key), std::move(text), inner.core());
    row.read = [member, core = inner.core()](void* object, const Field& field) {
      std::vector<U> values;
      for (const YamlNode& item : readList(field)) {
        const std::string path = field.path + "[" + std::to_string(values.size()) + "]";
        readTable(item, *core, &values.emplace_back(), path);
      }
      std::invoke(member, *static_cast<T*>(object)) = std::move(values);
    };
    row.sample = [](const void*) -> std::shared_ptr<const void> { return std::make_shared<const U>(); };
    row.write = [member, core = inner.core()](const void* object,
                                              Comments comments) -> std::optional<YamlNode> {
      YamlNode list = listNode();
      for (const U& value : std::invoke(member, *static_cast<const T*>(object))) {
        list.items.push_back(writeTable(*core, &value, comments));
      }
      return list;
    };
    core_->rows.push_back(std::move(row));
    return *this;
  }

  /// A key whose value chooses which of the alternatives declared after it applies.
  OptionTable& selector(std::string key, std::string text) {
    core_->selector = key;
    core_->rows.push_back({.option = {.kind = Option::Kind::Choice,
                                      .key = std::move(key),
                                      .text = std::move(text),
                                      .required = true}});
    selector_row_ = core_->rows.size() - 1;
    return *this;
  }

  /// When the selector says `name`, the keys of `inner` stand in the same table and fill alternative U of
  /// the std::variant member.
  template <class Member, class U>
  OptionTable& alternative(std::string name, Member member, const OptionTable<U>& inner, std::string text) {
    core_->rows[selector_row_].option.choices.push_back(name);
    core_->alternatives.push_back(
        {.name = std::move(name),
         .text = std::move(text),
         .table = inner.core(),
         .emplace = [member](void* object) -> void* {
           return &std::invoke(member, *static_cast<T*>(object)).template emplace<U>();
         },
         .held = [member](const void* object) -> const void* {
           return std::get_if<U>(&std::invoke(member, *static_cast<const T*>(object)));
         },
         .sample = [] { return std::make_shared<const U>(); }});
    return *this;
  }

  /// The key declared last has to be written.
  OptionTable& required() {
    core_->rows.back().option.required = true;
    return *this;
  }

  /// A rule across keys: `rule(const T&)` throws ConfigError whose key is relative to this table; place and
  /// full key path are added here.
  template <class Rule>
  OptionTable& check(Rule rule) {
    core_->checks.push_back([rule](const void* object) { (void)rule(*static_cast<const T*>(object)); });
    return *this;
  }

  std::shared_ptr<const TableCore> core() const { return core_; }

 private:
  template <class Member, class Read, class Write>
  OptionTable& leaf(Option option, Member member, Read read, Write write) {
    using Slot = detail::SlotOf<T, Member>;
    option.optional = Slot::kOptional;
    core_->rows.push_back({.option = std::move(option),
                           .read =
                               [member, read](void* object, const Field& field) {
                                 std::invoke(member, *static_cast<T*>(object)) = read(field);
                               },
                           .write = [member, write](const void* object, Comments) -> std::optional<YamlNode> {
                             const auto* value =
                                 Slot::held(std::invoke(member, *static_cast<const T*>(object)));
                             return value ? std::optional<YamlNode>(write(*value)) : std::nullopt;
                           }});
    return *this;
  }

  template <class Slot>
  static OptionRow nested(Option::Kind kind, std::string key, std::string text,
                          std::shared_ptr<const TableCore> inner) {
    return {
        .option = {.kind = kind, .key = std::move(key), .text = std::move(text), .optional = Slot::kOptional},
        .table = std::move(inner)};
  }

  std::shared_ptr<TableCore> core_;
  std::size_t selector_row_ = 0;
};

/// The struct that the document describes. Throws ConfigError.
template <class T>
T readOptions(const YamlDocument& document, const OptionTable<T>& table) {
  T object{};
  readTable(document.root, *table.core(), &object, "");
  return object;
}

/// YAML text of the struct with every key, which reads back to an equal struct.
template <class T>
std::string optionsYaml(const T& object, const OptionTable<T>& table) {
  return yamlText(writeTable(*table.core(), &object, Comments::None));
}

/// The same with every key explained above it, a file to start from.
template <class T>
std::string exampleYaml(const T& object, const OptionTable<T>& table) {
  return yamlText(writeTable(*table.core(), &object, Comments::Explained));
}

/// Reference for users: every key with type, unit, range, default and meaning.
template <class T>
std::string markdownReference(const OptionTable<T>& table) {
  const T defaults{};
  return markdownReference(*table.core(), &defaults);
}

/// JSON Schema, draft 2020-12, for editors. It knows no rules across keys; the reader does.
template <class T>
std::string jsonSchema(const OptionTable<T>& table) {
  const T defaults{};
  return jsonSchema(*table.core(), &defaults);
}

}  // namespace pos::io
