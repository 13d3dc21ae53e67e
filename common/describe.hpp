#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/range.hpp"

// A struct that a result file contains is described once, where it is made: the names of the
// members are the keys, in this order. A name that is reserved in C++ has "_" at its end. Writer,
// reader and schema follow from that (report/json/described.hpp).
//
//   struct Leak {
//     std::string level;
//     double share_percent = 0.0;
//     std::optional<std::string> reason;
//     RIGCAL_DESCRIBE(level, share_percent, reason)
//   };

// NOLINTBEGIN(cppcoreguidelines-macro-usage): only a macro knows the name of a member
#define RIGCAL_NOTHING ()
#define RIGCAL_AGAIN(...) \
  RIGCAL_AGAIN_64(RIGCAL_AGAIN_64(RIGCAL_AGAIN_64(RIGCAL_AGAIN_64(__VA_ARGS__))))
#define RIGCAL_AGAIN_64(...) \
  RIGCAL_AGAIN_16(RIGCAL_AGAIN_16(RIGCAL_AGAIN_16(RIGCAL_AGAIN_16(__VA_ARGS__))))
#define RIGCAL_AGAIN_16(...) \
  RIGCAL_AGAIN_4(RIGCAL_AGAIN_4(RIGCAL_AGAIN_4(RIGCAL_AGAIN_4(__VA_ARGS__))))
#define RIGCAL_AGAIN_4(...) __VA_ARGS__
#define RIGCAL_VISIT_MEMBERS(member, ...)                       \
  rigcal::described::visit_member(visit, #member, self.member); \
  __VA_OPT__(RIGCAL_VISIT_REST RIGCAL_NOTHING(__VA_ARGS__))
#define RIGCAL_VISIT_REST() RIGCAL_VISIT_MEMBERS
#define RIGCAL_DESCRIBE(...)                             \
  template <typename Self, typename Visit>               \
  static void describe(Self& self, const Visit& visit) { \
    RIGCAL_AGAIN(RIGCAL_VISIT_MEMBERS(__VA_ARGS__))      \
  }
// NOLINTEND(cppcoreguidelines-macro-usage)

namespace rigcal {

/// A value whose key is omitted if there is none: rigs differ in what they have.
template <typename T>
struct Omittable : std::optional<T> {
  using std::optional<T>::optional;
  Omittable() = default;
  Omittable(std::optional<T> value)  // NOLINT(google-explicit-constructor): it is one
      : std::optional<T>(std::move(value)) {}
};

/// A member that results of earlier versions lack: the default of T then.
template <typename T>
struct Later : T {
  using T::T;
  using T::operator=;
  Later() = default;
  Later(T value) : T(std::move(value)) {}  // NOLINT(google-explicit-constructor): it is one
};

/// Keys and values in their order.
template <typename T, typename Key = std::string>
using Keyed = std::vector<std::pair<Key, T>>;

/// A text; nothing where it is empty.
inline std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// A struct whose keys are among those of the struct that contains it.
template <typename T>
struct Inlined : T {
  Inlined() = default;
  Inlined(T value) : T(std::move(value)) {}  // NOLINT(google-explicit-constructor): it is one
};

namespace described {

template <typename T>
inline constexpr bool is_inlined = false;
template <typename T>
inline constexpr bool is_inlined<Inlined<T>> = true;

template <typename Visit, typename Member>
void visit_member(const Visit& visit, const char* name, Member& member) {
  if constexpr (is_inlined<std::remove_const_t<Member>>) {
    Member::describe(member, visit);
  } else {
    visit(name, member);
  }
}

}  // namespace described
}  // namespace rigcal
