#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/range.hpp"

// A struct that is written to result files is described once, in its definition: the names of the
// members are the keys, in this order. A name that is reserved in C++ gets a trailing "_". Writer,
// reader and schema are derived from this description (report/json/described.hpp).
//
//   struct Leak {
//     std::string level;
//     double share_percent = 0.0;
//     std::optional<std::string> reason;
//     RIGCAL_DESCRIBE(level, share_percent, reason)
//   };

// NOLINTBEGIN(cppcoreguidelines-macro-usage): only a macro has access to the name of a member
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

// The names of an enumeration in result files are those of its enumerators. They are listed once,
// behind its definition. An enumerator that is missing from the list does not compile (-Wswitch).
//
//   enum class Use { fit, validate };
//   RIGCAL_NAMES(Use, fit, validate)
#define RIGCAL_NAME_CASES(name, ...) \
  case name:                         \
    return #name;                    \
    __VA_OPT__(RIGCAL_NAME_REST RIGCAL_NOTHING(__VA_ARGS__))
#define RIGCAL_NAME_REST() RIGCAL_NAME_CASES
#define RIGCAL_NAMES(Enum, ...) \
  RIGCAL_TEXTS(Enum, RIGCAL_AGAIN(RIGCAL_NAME_CASES(__VA_ARGS__)), __VA_ARGS__)

// A text that is no identifier follows its enumerator:
//
//   RIGCAL_WORDS(Verdict, pass, "PASS", warn, "WARN")
#define RIGCAL_WORD_CASES(name, words, ...) \
  case name:                                \
    return words;                           \
    __VA_OPT__(RIGCAL_WORD_REST RIGCAL_NOTHING(__VA_ARGS__))
#define RIGCAL_WORD_REST() RIGCAL_WORD_CASES
#define RIGCAL_WITHOUT_WORDS(name, words, ...) \
  name, __VA_OPT__(RIGCAL_WITHOUT_REST RIGCAL_NOTHING(__VA_ARGS__))
#define RIGCAL_WITHOUT_REST() RIGCAL_WITHOUT_WORDS
#define RIGCAL_WORDS(Enum, ...)                                    \
  RIGCAL_TEXTS(Enum, RIGCAL_AGAIN(RIGCAL_WORD_CASES(__VA_ARGS__)), \
               RIGCAL_AGAIN(RIGCAL_WITHOUT_WORDS(__VA_ARGS__)))

#define RIGCAL_TEXTS(Enum, cases, ...)               \
  constexpr std::string_view to_string(Enum value) { \
    using enum Enum;                                 \
    switch (value) { cases }                         \
    return {};                                       \
  }                                                  \
  inline std::vector<Enum> enumerators_like(Enum) {  \
    using enum Enum;                                 \
    return {__VA_ARGS__};                            \
  }
// NOLINTEND(cppcoreguidelines-macro-usage)

namespace rigcal {

/// An optional value whose key is left out of a result if it is absent, because rigs differ in the
/// quantities that they have.
template <typename T>
struct Omittable : std::optional<T> {
  using std::optional<T>::optional;
  Omittable() = default;
  Omittable(std::optional<T> value)  // NOLINT(google-explicit-constructor): as in std::optional
      : std::optional<T>(std::move(value)) {}
};

/// A member that did not exist in results of earlier versions. When such a result is read, the
/// member has the default of T.
template <typename T>
struct Later : T {
  using T::T;
  using T::operator=;
  Later() = default;
  Later(T value) : T(std::move(value)) {}  // NOLINT(google-explicit-constructor): a T itself
};

/// Pairs of key and value, in their order.
template <typename T, typename Key = std::string>
using Keyed = std::vector<std::pair<Key, T>>;

/// A list of structs that a result has in columns: an object for each described member of the
/// structs, which has its values by their `channel`. The columns are among the keys of the struct
/// that contains the list.
template <typename T>
struct Columns : std::vector<T> {
  using std::vector<T>::vector;
};

/// Returns the text, or std::nullopt if it is empty.
inline std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// A struct whose keys are among those of the struct that contains it.
template <typename T>
struct Inlined : T {
  Inlined() = default;
  Inlined(T value) : T(std::move(value)) {}  // NOLINT(google-explicit-constructor): a T itself
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
