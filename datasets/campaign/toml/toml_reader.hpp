#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "datasets/campaign/toml/quantity_range.hpp"

namespace rigcal::datasets {

/// Maximum size of a campaign file, much larger than any that is written by hand.
inline constexpr std::uintmax_t kMaxCampaignBytes = std::uintmax_t{16} << 20;

/// Parses a TOML file.
///
/// @throws InputError  if the file is not a regular file, cannot be read, is too large, has keys
///                     with too many parts, or has a syntax error (names line and column)
toml::table parse_toml_file(const std::filesystem::path& path);

/// Writes a text as a TOML basic string on one line, including quotes. Escapes control characters.
std::string toml_quoted(std::string_view text);

/// Writes a TOML key, with quotes only if it needs them.
std::string toml_key(std::string_view key);

/// Writes a number as a TOML float, or for use in a quantity. It round-trips exactly.
std::string toml_number(double value);

/// One value in a TOML file, with its place for error messages. Has functions to convert the value.
/// Borrows the parsed file.
class TomlNode {
 public:
  /// @param path  full key as a user would write it: "rig.parameters.mass"
  TomlNode(const toml::node& node, std::string file, std::string path)
      : node_(&node), file_(std::move(file)), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  Location where() const { return location(node_->source()); }

  /// @throws InputError  always: "file:line:column: key 'path': message"
  [[noreturn]] void fail(const std::string& message) const;
  /// @throws InputError  always: "... found X, expected Y"
  [[noreturn]] void fail_type(const std::string& expected) const;

  bool is_table() const { return node_->is_table(); }
  bool is_array() const { return node_->is_array(); }
  bool is_string() const { return node_->is_string(); }
  bool is_boolean() const { return node_->is_boolean(); }

  // Conversions. Each throws InputError if the value has another type.

  std::string string(const std::string& expected = "text in quotes") const;
  /// Returns a non-empty text.
  std::string name(const std::string& expected = "text in quotes") const;
  bool boolean() const;
  /// Returns a finite number without a unit, integer or not.
  double number() const;
  int integer(int lowest, int highest) const;
  /// Reads a text "number unit" and converts it to `unit`. For unit "1", reads a plain number.
  double quantity(std::string_view unit) const;
  /// Reads a quantity within a range.
  double quantity(std::string_view unit, QuantityRange range) const;
  /// Reads a difference between two quantities: "2 degC" is 2 K.
  double difference(std::string_view unit) const;
  /// Reads a difference within a range, such as a standard deviation or a step.
  double difference(std::string_view unit, QuantityRange range) const;
  /// Returns a plain number within a range.
  double number(QuantityRange range) const;
  /// Returns a TOML date, or date and time, as text.
  std::string date() const;
  std::vector<TomlNode> items() const;

  /// Looks up this text among the names of the choices, and returns the value of the match.
  template <typename Value>
  Value choice(const std::vector<std::pair<std::string, Value>>& choices) const {
    const std::string found = string(choice_list(choices));
    for (const auto& [name, value] : choices) {
      if (name == found) return value;
    }
    fail_choice(found, names_of(choices));
  }

  // Access to tables.

  std::optional<TomlNode> find(std::string_view key) const;
  /// @param expected  describes the value, for the message
  /// @throws InputError  if the key is missing
  TomlNode require(std::string_view key, const std::string& expected) const;
  /// Returns keys and values in the order of the file.
  std::vector<std::pair<std::string, TomlNode>> entries() const;
  /// Checks the keys of a table.
  ///
  /// @throws InputError  if this is not a table, or has a key that is not in `known`; names the
  ///                     nearest known key
  void allow_only(const std::vector<std::string>& known) const;
  /// Reports an unknown key with the nearest known one. `what` is the kind of key, such as
  /// "channel".
  [[noreturn]] void fail_unknown(std::string_view key, std::string_view what,
                                 const std::vector<std::string>& known) const;
  /// Returns the value with another name for messages.
  TomlNode renamed(std::string path) const { return {*node_, file_, std::move(path)}; }
  /// Returns the value with a remark that is appended to every message about it.
  TomlNode noted(const std::string& note) const {
    TomlNode result = *this;
    result.note_ = " (" + note + ")";
    return result;
  }

 private:
  const toml::table& table() const;
  double within(QuantityRange range, std::string_view unit, double value) const;
  Location location(const toml::source_region& source) const;
  TomlNode child(std::string_view key, const toml::node& node) const;
  [[noreturn]] void fail_choice(const std::string& found,
                                const std::vector<std::string>& names) const;
  template <typename Value>
  static std::vector<std::string> names_of(
      const std::vector<std::pair<std::string, Value>>& choices) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    return names;
  }
  template <typename Value>
  static std::string choice_list(const std::vector<std::pair<std::string, Value>>& choices) {
    std::string text = "one of";
    for (const auto& choice : choices) text.append(" ").append(toml_quoted(choice.first));
    return text;
  }

  const toml::node* node_;
  std::string file_;
  std::string path_;
  std::string note_;
};

}  // namespace rigcal::datasets
