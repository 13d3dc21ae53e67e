#pragma once

#include <fmt/format.h>

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "datasets/campaign/keys/key_form.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

namespace rigcal::datasets {

/// Words that a key accepts, with their values.
template <typename T>
using Words = std::vector<std::pair<std::string, T>>;

template <typename T>
std::vector<std::string> words_of(const Words<T>& words) {
  std::vector<std::string> texts;
  for (const auto& word : words) texts.push_back(word.first);
  return texts;
}

/// Returns the names of an enumeration that has RIGCAL_NAMES.
template <typename Enum>
Words<Enum> enumerator_words() {
  Words<Enum> words;
  for (const Enum each : enumerators_like(Enum{})) words.emplace_back(to_string(each), each);
  return words;
}

/// Texts about a key; see CampaignKey.
struct KeyAbout {
  std::string doc{};
  std::string otherwise{};
  std::string example{};
  std::string hint{};
  std::string needed{};  ///< expectation in the message about a missing key; empty: the key is
                         ///< optional
};

/// Limits of a plain number that a QuantityRange cannot express.
struct NumberLimits {
  QuantityRange range;
  std::string_view expected;  ///< wording for messages
  bool above_lower = false;
  bool below_upper = false;
};

/// A row with the function that stores the value in the settings. A row without that function only
/// describes its key. The reader of the table then reads the value, because it depends on the rig
/// or on other keys.
template <typename S>
struct KeyRow {
  using Read = std::function<void(const TomlNode&, S&)>;
  CampaignKey info;
  Read read{};
  std::string expected{};

  static KeyRow custom(std::string_view key, KeyForm form, Read read, const KeyAbout& about) {
    return {{std::string(key),
             std::move(form),
             about.doc,
             {},
             about.otherwise,
             !about.needed.empty(),
             about.example,
             about.hint},
            std::move(read),
            about.needed};
  }

  static KeyRow described(std::string_view key, KeyForm form, const KeyAbout& about) {
    return custom(key, std::move(form), {}, about);
  }

  // `member` is a member of S, or a function from S to a reference. It may be an optional.

  template <typename Member>
  static KeyRow quantity(std::string_view key, Member member, std::string_view unit,
                         QuantityRange range, const KeyAbout& about) {
    KeyRow row = custom(
        key, quantity_form(unit),
        [member, unit = std::string(unit), range](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = node.quantity(unit, range);
        },
        about);
    if (const auto value = default_of<double>(member);
        value && about.otherwise.empty() && about.needed.empty())
      row.info.standard = fmt::format("\"{:g} {}\"", *value, unit);
    return row;
  }

  template <typename Member>
  static KeyRow number(std::string_view key, Member member, QuantityRange range,
                       const KeyAbout& about) {
    return number_row(
        key, number_form(range), member,
        [range](const TomlNode& node) { return node.number(range); }, about);
  }

  template <typename Member>
  static KeyRow number(std::string_view key, Member member, const NumberLimits& limits,
                       const KeyAbout& about) {
    KeyForm form = number_form(limits.range);
    form.above_lower = limits.above_lower;
    form.below_upper = limits.below_upper;
    return number_row(
        key, std::move(form), member,
        [limits](const TomlNode& node) {
          const double value = node.number();
          const bool high =
              limits.above_lower ? value > limits.range.lower : value >= limits.range.lower;
          const bool low =
              limits.below_upper ? value < limits.range.upper : value <= limits.range.upper;
          if (!high || !low) node.fail_type(std::string(limits.expected));
          return value;
        },
        about);
  }

  template <typename Member>
  static KeyRow whole(std::string_view key, Member member, int lowest, int highest,
                      const KeyAbout& about) {
    KeyRow row = custom(
        key, whole_form(lowest, highest),
        [member, lowest, highest](const TomlNode& node, S& settings) {
          using Value = std::remove_reference_t<decltype(std::invoke(member, settings))>;
          if constexpr (std::integral<Value>) {
            std::invoke(member, settings) = static_cast<Value>(node.integer(lowest, highest));
          } else {
            std::invoke(member, settings) = node.integer(lowest, highest);
          }
        },
        about);
    if (const auto value = default_of<long>(member);
        value && about.otherwise.empty() && about.needed.empty())
      row.info.standard = fmt::format("{}", *value);
    return row;
  }

  template <typename Member>
  static KeyRow flag(std::string_view key, Member member, const KeyAbout& about) {
    KeyRow row = custom(
        key, plain_form(KeyForm::Kind::flag),
        [member](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = node.boolean();
        },
        about);
    if (const auto value = default_of<bool>(member)) row.info.standard = fmt::format("{}", *value);
    return row;
  }

  /// Makes a row for a text that must not be empty.
  template <typename Member>
  static KeyRow text(std::string_view key, Member member, std::string_view expected,
                     const KeyAbout& about) {
    return custom(
        key, plain_form(KeyForm::Kind::text),
        [member, expected = std::string(expected)](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = node.name(expected);
        },
        about);
  }

  template <typename Member>
  static KeyRow date(std::string_view key, Member member, const KeyAbout& about) {
    return custom(
        key, plain_form(KeyForm::Kind::date),
        [member](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = node.date();
        },
        about);
  }

  template <typename Enum, typename Member>
  static KeyRow word(std::string_view key, Member member, const KeyAbout& about) {
    return word<Enum>(key, member, enumerator_words<Enum>(), about);
  }

  template <typename T, typename Member>
  static KeyRow word(std::string_view key, Member member, Words<T> words, const KeyAbout& about) {
    KeyForm form = word_form(words_of(words));
    std::string standard;
    if (const auto value = default_of<T>(member);
        value && about.otherwise.empty() && about.needed.empty()) {
      for (const auto& [name, each] : words)
        if (each == *value) standard = toml_quoted(name);
    }
    KeyRow row = custom(
        key, std::move(form),
        [member, words = std::move(words)](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = node.choice(words);
        },
        about);
    row.info.standard = standard;
    return row;
  }

 private:
  template <typename Member, typename ReadNumber>
  static KeyRow number_row(std::string_view key, KeyForm form, Member member, ReadNumber read,
                           const KeyAbout& about) {
    KeyRow row = custom(
        key, std::move(form),
        [member, read](const TomlNode& node, S& settings) {
          std::invoke(member, settings) = read(node);
        },
        about);
    if (const auto value = default_of<double>(member);
        value && about.otherwise.empty() && about.needed.empty())
      row.info.standard = fmt::format("{:g}", *value);
    return row;
  }

  /// Returns the default value of a member; std::nullopt if the member is optional.
  template <typename T, typename Member>
  static std::optional<T> default_of(const Member& member) {
    S settings{};
    const auto& value = std::invoke(member, settings);
    if constexpr (requires { value.has_value(); }) {
      return std::nullopt;
    } else {
      return static_cast<T>(value);
    }
  }
};

/// The keys of one table of a campaign file.
template <typename S>
class KeyTable {
 public:
  explicit KeyTable(std::vector<KeyRow<S>> rows) : rows_(std::move(rows)) {
    for (const KeyRow<S>& row : rows_) {
      infos_.push_back(row.info);
      names_.push_back(row.info.key);
    }
  }

  /// Reads the table in the order of its rows.
  ///
  /// @throws InputError  if a key is unknown or missing, or a row refuses its value
  void read(const TomlNode& node, S& settings) const {
    node.allow_only(names_);
    read_rows(node, settings);
  }
  /// Reads a table that also has keys for other readers.
  void read_rows(const TomlNode& node, S& settings) const {
    for (const KeyRow<S>& row : rows_) {
      const auto value = row.info.needed ? std::optional(node.require(row.info.key, row.expected))
                                         : node.find(row.info.key);
      if (value && row.read) row.read(*value, settings);
    }
  }

  const std::vector<CampaignKey>& keys() const { return infos_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<KeyRow<S>> rows_;
  std::vector<CampaignKey> infos_;
  std::vector<std::string> names_;
};

}  // namespace rigcal::datasets
