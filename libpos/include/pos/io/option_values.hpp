#pragma once
/// How members of a struct hold the values of an option table.

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace pos::io::detail {

/// Members of type std::optional may be absent.
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

}  // namespace pos::io::detail
