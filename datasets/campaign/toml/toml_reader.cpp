#include "datasets/campaign/toml/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>
#include <tuple>

#include "common/file.hpp"
#include "common/quantity.hpp"
#include "common/suggest.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kLongestShown = 100;
constexpr int kMostKeyParts = 32;

bool starts_with_at(std::string_view text, std::size_t position, std::string_view wanted) {
  return text.compare(position, wanted.size(), wanted) == 0;
}

/// Finds the end (one past the closing quotes) of the string that opens at `begin`.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool multi_line = starts_with_at(text, begin, three);
  std::size_t i = begin + (multi_line ? 3 : 1);
  while (i < text.size()) {
    if (multi_line && starts_with_at(text, i, three)) return i + 3;
    if (!multi_line && (text[i] == quote || text[i] == '\n')) return i + 1;
    i += text[i] == '\\' && quote == '"' ? 2 : 1;
  }
  return text.size();
}

/// Limits the number of parts in a dotted key. toml++ nests one table per part and destroys the
/// tables recursively, so that a key with a hundred thousand parts would exhaust the stack. toml++
/// itself limits the depth of arrays and inline tables.
void check_key_depth(std::string_view text, const std::string& file) {
  int parts = 1;
  long line = 1;
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      const std::size_t end = std::min(end_of_string(text, i), text.size());
      line += std::count(text.data() + i, text.data() + end, '\n');
      i = end;
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '\n') ++line;
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) parts = 1;
    if (c == '.' && ++parts > kMostKeyParts) {
      throw InputError({file, line, 0},
                       fmt::format("a key of more than {} parts; expected the keys "
                                   "of a campaign file",
                                   kMostKeyParts));
    }
    ++i;
  }
}

std::string quoted_start(std::string_view text) {
  if (text.size() <= kLongestShown) return toml_quoted(text);
  std::size_t end = kLongestShown;
  // The cut must not split a UTF-8 character.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return toml_quoted(text.substr(0, end)) + "...";
}

std::string described(const toml::node& node) {
  if (const auto* value = node.as_string()) return "the text " + quoted_start(value->get());
  if (const auto* value = node.as_integer()) return fmt::format("the number {}", value->get());
  if (const auto* value = node.as_floating_point()) {
    return fmt::format("the number {}", value->get());
  }
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  return "a date or time";
}

/// Returns the text after the number: "MPa" for "6.2 MPa"; empty if the text does not begin with a
/// number.
std::string_view unit_part(std::string_view text) {
  const auto begin = std::min(text.find_first_not_of(" \t+"), text.size());
  double number = 0.0;
  const auto [rest, error] =
      std::from_chars(text.data() + begin, text.data() + text.size(), number);
  return error == std::errc{}
             ? std::string_view(rest, static_cast<std::size_t>(text.data() + text.size() - rest))
             : std::string_view{};
}

}  // namespace

toml::table parse_toml_file(const std::filesystem::path& path) {
  const std::string text = read_file(path, kMaxCampaignBytes, "a campaign file (TOML)");
  const std::string file = path.string();
  check_key_depth(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError({file, static_cast<long>(error.source().begin.line),
                      static_cast<long>(error.source().begin.column)},
                     fmt::format("not valid TOML: {}", error.description()));
  }
}

std::string toml_quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result.append("\\").push_back(c);
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      result += fmt::format("\\u{:04X}", byte);
    } else {
      result.push_back(c);
    }
  }
  return result + "\"";
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? std::string(key) : toml_quoted(key);
}

std::string toml_number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

void TomlNode::fail(const std::string& message) const {
  throw InputError(where(), path_.empty() ? message + note_
                                          : fmt::format("key '{}': {}{}", path_, message, note_));
}

void TomlNode::fail_type(const std::string& expected) const {
  fail(fmt::format("found {}, expected {}", described(*node_), expected));
}

std::string TomlNode::string(const std::string& expected) const {
  const auto* value = node_->as_string();
  if (value == nullptr) fail_type(expected);
  return value->get();
}

std::string TomlNode::name(const std::string& expected) const {
  std::string value = string(expected);
  if (value.empty()) fail_type(expected + " that is not empty");
  return value;
}

bool TomlNode::boolean() const {
  const auto* value = node_->as_boolean();
  if (value == nullptr) fail_type("true or false");
  return value->get();
}

double TomlNode::number() const {
  const auto value = node_->is_number() ? node_->value<double>() : std::nullopt;
  if (!value) fail_type("a plain number such as 0.3, without quotes: it has no unit");
  if (!std::isfinite(*value)) fail_type("a finite number");
  return *value;
}

int TomlNode::integer(int lowest, int highest) const {
  const auto* value = node_->as_integer();
  if (value == nullptr || value->get() < lowest || value->get() > highest) {
    fail_type(fmt::format("a whole number from {} to {}", lowest, highest));
  }
  return static_cast<int>(value->get());
}

double TomlNode::quantity(std::string_view unit) const {
  if (unit == "1") return number();
  const auto* text = node_->as_string();
  if (text == nullptr) {
    fail_type(fmt::format("text \"number unit\" such as \"{} {}\"",
                          node_->value<double>().value_or(1.5), unit));
  }
  try {
    return parse_quantity(text->get(), unit);
  } catch (const QuantityError& error) {
    fail(error.what());
  }
}

double TomlNode::within(QuantityRange range, std::string_view unit, double value) const {
  if (value >= range.lower && value <= range.upper) return value;
  const std::string_view what = unit == "1" ? "number" : "quantity";
  if (range.lower == 0.0 && value < 0.0) fail_type(fmt::format("a {} that is not negative", what));
  if (range.lower > 0.0 && value <= 0.0) fail_type(fmt::format("a {} above zero", what));
  fail_type(fmt::format("a {} from {:g} to {:g}{}{}", what, range.lower, range.upper,
                        unit == "1" ? "" : " ", unit == "1" ? "" : unit));
}

double TomlNode::quantity(std::string_view unit, QuantityRange range) const {
  return within(range, unit, quantity(unit));
}

double TomlNode::number(QuantityRange range) const { return within(range, "1", number()); }

double TomlNode::difference(std::string_view unit) const {
  const double value = quantity(unit);
  if (unit == "1") return value;
  const double zero = parse_quantity(
      fmt::format("0 {}", unit_part(node_->value<std::string_view>().value_or(""))), unit);
  // The subtraction loses digits, so it is done only for scales with an offset (degC).
  return zero == 0.0 ? value : value - zero;
}

double TomlNode::difference(std::string_view unit, QuantityRange range) const {
  return within(range, unit, difference(unit));
}

std::string TomlNode::date() const {
  std::ostringstream text;
  if (const auto* day = node_->as_date()) {
    text << day->get();
  } else if (const auto* time = node_->as_date_time()) {
    text << time->get();
  } else {
    fail_type("a date such as 2026-03-01, without quotes");
  }
  return text.str();
}

std::vector<TomlNode> TomlNode::items() const {
  const auto* array = node_->as_array();
  if (array == nullptr) fail_type("a list in brackets");
  std::vector<TomlNode> result;
  for (const toml::node& item : *array) {
    result.emplace_back(item, file_, fmt::format("{}[{}]", path_, result.size() + 1));
  }
  return result;
}

std::optional<TomlNode> TomlNode::find(std::string_view key) const {
  const toml::node* node = table().get(key);
  if (node == nullptr) return std::nullopt;
  return child(key, *node);
}

TomlNode TomlNode::require(std::string_view key, const std::string& expected) const {
  if (auto node = find(key)) return *node;
  throw InputError(where(), fmt::format("key '{}{}{}' is missing: expected {}", path_,
                                        path_.empty() ? "" : ".", key, expected));
}

std::vector<std::pair<std::string, TomlNode>> TomlNode::entries() const {
  std::vector<std::tuple<toml::source_position, std::string, const toml::node*>> found;
  for (const auto& [key, node] : table()) {
    found.emplace_back(key.source().begin, std::string(key.str()), &node);
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
  std::vector<std::pair<std::string, TomlNode>> result;
  for (const auto& [place, key, node] : found) result.emplace_back(key, child(key, *node));
  return result;
}

void TomlNode::allow_only(const std::vector<std::string>& known) const {
  for (const auto& entry : entries()) {
    const std::string& key = entry.first;
    if (std::find(known.begin(), known.end(), key) == known.end()) fail_unknown(key, "key", known);
  }
}

void TomlNode::fail_unknown(std::string_view key, std::string_view what,
                            const std::vector<std::string>& known) const {
  const auto entry = table().find(key);
  const Location place = entry == table().end() ? where() : location((*entry).first.source());
  const std::string name = quoted_start(key);
  throw InputError(place,
                   fmt::format("{}{}", path_.empty() ? "" : fmt::format("key '{}': ", path_),
                               unknown_name_message(what, name.substr(1, name.size() - 2), known)));
}

const toml::table& TomlNode::table() const {
  const auto* table = node_->as_table();
  if (table == nullptr) fail_type("a table");
  return *table;
}

Location TomlNode::location(const toml::source_region& source) const {
  return {file_, static_cast<long>(source.begin.line), static_cast<long>(source.begin.column)};
}

TomlNode TomlNode::child(std::string_view key, const toml::node& node) const {
  const std::string name = key.size() > kLongestShown ? quoted_start(key) : toml_key(key);
  return {node, file_, path_.empty() ? name : fmt::format("{}.{}", path_, name)};
}

void TomlNode::fail_choice(const std::string& found, const std::vector<std::string>& names) const {
  const std::string text = quoted_start(found);
  fail(unknown_name_message("value", text.substr(1, text.size() - 2), names));
}

}  // namespace rigcal::datasets
