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

/// Larger campaign files are refused: no campaign written by hand comes near.
inline constexpr std::uintmax_t kMaxCampaignBytes = std::uintmax_t{16} << 20;

/// Parses a TOML file.
///
/// @throws InputError  not a regular file, unreadable, too large, keys nested without end, or a
///                     syntax error, with line and column
toml::table parse_toml_file(const std::filesystem::path& path);

/// `text` as a TOML basic string in one line, quotes included. Control characters are escaped.
std::string toml_quoted(std::string_view text);

/// A key as TOML needs it: bare where it may be, quoted otherwise.
std::string toml_key(std::string_view key);

/// A number as an exact TOML float or a part of a quantity: reading it again gives the same bits.
std::string toml_number(double value);

/// One value of a TOML file with its place. It converts itself; an error says what is wrong and
/// where. Borrows the parsed file.
class TomlNode {
 public:
  /// @param path  full key as the user would write it: "rig.parameters.mass"
  TomlNode(const toml::node& node, std::string file, std::string path)
      : node_(&node), file_(std::move(file)), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  Location where() const { return location(node_->source()); }

  /// @throws InputError  "file:line:column: key 'path': message", always
  [[noreturn]] void fail(const std::string& message) const;
  /// @throws InputError  "... found X, expected Y", always
  [[noreturn]] void fail_type(const std::string& expected) const;

  bool is_table() const { return node_->is_table(); }
  bool is_array() const { return node_->is_array(); }
  bool is_string() const { return node_->is_string(); }
  bool is_boolean() const { return node_->is_boolean(); }

  // Conversions; each throws InputError where the value is of another type.

  std::string string(const std::string& expected = "a text in quotes") const;
  /// Text that is not empty.
  std::string name(const std::string& expected = "a text in quotes") const;
  bool boolean() const;
  /// Finite plain number, integer or not.
  double number() const;
  int integer(int lowest, int highest) const;
  /// Text "number unit" in `unit` ("1": a plain number instead).
  double quantity(std::string_view unit) const;
  /// Quantity within a range.
  double quantity(std::string_view unit, QuantityRange range) const;
  /// Like quantity(), of a difference: "2 degC" is 2 K.
  double difference(std::string_view unit) const;
  /// Difference within a range: standard deviations, steps.
  double difference(std::string_view unit, QuantityRange range) const;
  /// Plain number within a range.
  double number(QuantityRange range) const;
  /// TOML date, or date and time, as text.
  std::string date() const;
  std::vector<TomlNode> items() const;

  /// One of the names of a table {name, value}.
  template <typename Value>
  Value choice(const std::vector<std::pair<std::string, Value>>& choices) const {
    const std::string found = string(choice_list(choices));
    for (const auto& [name, value] : choices) {
      if (name == found) return value;
    }
    fail_choice(found, names_of(choices));
  }

  // Tables.

  std::optional<TomlNode> find(std::string_view key) const;
  /// @throws InputError  the key is missing; `expected` describes its value
  TomlNode require(std::string_view key, const std::string& expected) const;
  /// Keys and values in the order of the file.
  std::vector<std::pair<std::string, TomlNode>> entries() const;
  /// @throws InputError  not a table, or it has a key that is not among `known`, naming the nearest
  void allow_only(const std::vector<std::string>& known) const;
  /// Like allow_only() for one key; `what` names its kind ("channel").
  [[noreturn]] void fail_unknown(std::string_view key, std::string_view what,
                                 const std::vector<std::string>& known) const;
  /// The same value under another name in messages.
  TomlNode renamed(std::string path) const { return {*node_, file_, std::move(path)}; }
  /// The same value with a remark after every message about it.
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
