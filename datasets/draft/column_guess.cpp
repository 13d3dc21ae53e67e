#include "datasets/draft/column_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "common/quantity.hpp"
#include "datasets/draft/name_words.hpp"
#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

// ---- Words ---------------------------------------------------------------------------------

/// Something that a part of a name says.
struct Token {
  Meaning meaning;
  bool is_symbol = false;  ///< one letter, such as p for a pressure
};

/// Quantities, as words name them and as units have them.
constexpr std::array kQuantities{
    std::pair<Meaning, std::string_view>{Meaning::position, "m"},
    std::pair<Meaning, std::string_view>{Meaning::angle, "rad"},
    std::pair<Meaning, std::string_view>{Meaning::force, "N"},
    std::pair<Meaning, std::string_view>{Meaning::pressure, "Pa"},
    std::pair<Meaning, std::string_view>{Meaning::acceleration, "m/s2"},
    std::pair<Meaning, std::string_view>{Meaning::temperature, "K"},
    std::pair<Meaning, std::string_view>{Meaning::velocity, "m/s"},
    std::pair<Meaning, std::string_view>{Meaning::flow, "m3/s"},
    std::pair<Meaning, std::string_view>{Meaning::torque, "N m"},
    std::pair<Meaning, std::string_view>{Meaning::rotation, "rad/s"},
    std::pair<Meaning, std::string_view>{Meaning::time, "s"}};

bool is_quantity(Meaning meaning) {
  return meaning != Meaning::time &&
         std::any_of(kQuantities.begin(), kQuantities.end(),
                     [meaning](const auto& quantity) { return quantity.first == meaning; });
}

/// Lowers the letters of ASCII and, in UTF-8, those of Latin-1: "Ö" too.
std::string lower(std::string_view text) {
  std::string result(text);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto byte = static_cast<unsigned char>(result[i]);
    const bool follows_c3 = i > 0 && static_cast<unsigned char>(result[i - 1]) == 0xC3;
    if (byte < 0x80)
      result[i] = static_cast<char>(std::tolower(byte));
    else if (follows_c3 && byte <= 0x9E && byte != 0x97)
      result[i] = static_cast<char>(byte + 0x20);
  }
  return result;
}

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

/// Splits a name at separators, and letters from digits: "pA_bar_03" into "pa", "bar", "03".
std::vector<std::string> parts_of(std::string_view name) {
  constexpr std::string_view kBetween = "_ []()-/:,;#";
  std::vector<std::string> parts(1);
  for (const char c : lower(name)) {
    const bool between = kBetween.find(c) != std::string_view::npos;
    const bool changes =
        !parts.back().empty() && is_decimal_digit(c) != is_decimal_digit(parts.back().back());
    if (between || changes) parts.emplace_back();
    if (!between) parts.back() += c;
  }
  std::erase(parts, std::string());
  return parts;
}

std::vector<Token> meanings_of(std::string_view word) {
  std::vector<Token> tokens;
  for (const WordRow& row : name_words())
    if (std::find(row.words.begin(), row.words.end(), word) != row.words.end())
      tokens.push_back({row.meaning});
  return tokens;
}

std::optional<Meaning> symbol_in(std::span<const Symbol> symbols, std::string_view text) {
  if (text.size() != 1) return std::nullopt;
  const auto found = std::find_if(symbols.begin(), symbols.end(),
                                  [&](const Symbol& each) { return each.letter == text[0]; });
  return found == symbols.end() ? std::nullopt : std::optional(found->meaning);
}

bool has(std::span<const Token> tokens, Meaning meaning) {
  return std::any_of(tokens.begin(), tokens.end(),
                     [meaning](const Token& token) { return token.meaning == meaning; });
}

/// Splits joined words, such as "istweg" into "ist" and "weg". The last may be the place of a
/// pressure: "drucka". Returns nothing unless the whole text consists of words.
std::vector<Token> joined_words(std::string_view text, bool is_pressure) {
  constexpr std::size_t kShortest = 3;
  for (std::size_t length = text.size(); length >= kShortest; --length) {
    std::vector<Token> tokens = meanings_of(text.substr(0, length));
    if (tokens.empty() || length == text.size()) {
      if (!tokens.empty()) return tokens;
      continue;
    }
    const bool pressure = is_pressure || has(tokens, Meaning::pressure);
    const auto rest = joined_words(text.substr(length), pressure);
    if (rest.empty()) continue;
    tokens.insert(tokens.end(), rest.begin(), rest.end());
    return tokens;
  }
  const auto place = symbol_in(pressure_places(), text);
  return is_pressure && place ? std::vector{Token{*place}} : std::vector<Token>{};
}

/// Returns the meaning of a part of a name: words, or a symbol with words or a place joined to it
/// ("xref", "pa").
std::vector<Token> tokens_of(std::string_view part, std::span<const Token> before) {
  if (const auto place = symbol_in(pressure_places(), part);
      place && has(before, Meaning::pressure))
    return {{*place}};
  if (const auto symbol = symbol_in(quantity_symbols(), part)) return {{*symbol, true}};
  if (auto whole = meanings_of(part); !whole.empty()) return whole;
  if (auto words = joined_words(part, false); !words.empty()) return words;
  const auto symbol = symbol_in(quantity_symbols(), part.substr(0, 1));
  if (!symbol) return {};
  const auto rest = joined_words(part.substr(1), *symbol == Meaning::pressure);
  if (rest.empty()) return {};
  std::vector<Token> tokens{{*symbol, true}};
  tokens.insert(tokens.end(), rest.begin(), rest.end());
  return tokens;
}

// ---- Meaning -------------------------------------------------------------------------------

std::optional<Meaning> quantity_of_unit(const std::string& unit) {
  for (const auto& [meaning, si] : kQuantities)
    if (converts_to(unit, si)) return meaning;
  return std::nullopt;
}

/// What the words of a name say together.
struct Reading {
  std::vector<Token> tokens;
  std::string unit;
  std::optional<Meaning> of_unit;  ///< quantity that has the unit

  bool says(Meaning meaning) const { return has(tokens, meaning); }

  /// Returns the first quantity that a word names, or else a symbol. Symbols other than those of a
  /// coordinate, a pressure or a force count only at the beginning of a name: "cmd_v" is in volts.
  std::optional<Meaning> of_name() const {
    for (const Token& token : tokens)
      if (!token.is_symbol && is_quantity(token.meaning)) return token.meaning;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const Meaning meaning = tokens[i].meaning;
      const bool anywhere =
          meaning == Meaning::position || meaning == Meaning::pressure || meaning == Meaning::force;
      if (is_quantity(meaning) && (i == 0 || anywhere)) return meaning;
    }
    return std::nullopt;
  }

  bool is_named() const {
    return std::any_of(tokens.begin(), tokens.end(), [](const Token& token) {
      return !token.is_symbol && is_quantity(token.meaning);
    });
  }
};

/// Whether a unit is that of a pure number, such as a percentage.
bool is_share(const std::string& unit) { return converts_to(unit, "1"); }

std::optional<Meaning> quantity_in(const Reading& reading) {
  if (reading.of_unit && *reading.of_unit != Meaning::time) return reading.of_unit;
  const auto quantity = reading.of_name();
  // "y_%" may be the spool as well as the piston.
  if (is_share(reading.unit) && !reading.is_named()) return std::nullopt;
  return quantity;
}

bool is_time(const Reading& reading) {
  if (reading.of_unit && *reading.of_unit != Meaning::time) return false;
  const auto known = std::find_if(reading.tokens.begin(), reading.tokens.end(),
                                  [](const Token& t) { return t.meaning != Meaning::filler; });
  return known != reading.tokens.end() && known->meaning == Meaning::time &&
         !has(reading.tokens, Meaning::temperature);
}

std::optional<Channel> reference_of(Meaning quantity, const Reading& reading) {
  const bool is_of_one_side = reading.says(Meaning::side_a) || reading.says(Meaning::side_b) ||
                              reading.says(Meaning::supply) || reading.says(Meaning::tank);
  switch (quantity) {
    case Meaning::position:
      return Channel::reference;
    case Meaning::angle:
      return Channel::angle_reference;
    case Meaning::force:
      return Channel::force_reference;
    case Meaning::torque:
      return Channel::torque_reference;
    case Meaning::acceleration:
      return Channel::acceleration_reference;
    case Meaning::pressure:
      return is_of_one_side ? std::nullopt : std::optional(Channel::load_pressure_reference);
    default:
      return std::nullopt;  // no loop controls it
  }
}

std::optional<Channel> pressure_at(const Reading& reading) {
  constexpr std::array kPlaces{std::pair{Meaning::pilot, Channel::pilot_pressure},
                               std::pair{Meaning::side_a, Channel::pressure_a},
                               std::pair{Meaning::side_b, Channel::pressure_b},
                               std::pair{Meaning::supply, Channel::supply_pressure},
                               std::pair{Meaning::tank, Channel::tank_pressure},
                               std::pair{Meaning::load, Channel::load_pressure},
                               std::pair{Meaning::piston, Channel::pressure_a}};
  for (const Token& token : reading.tokens)
    for (const auto& [place, channel] : kPlaces)
      if (token.meaning == place && place != Meaning::piston) return channel;
  if (reading.says(Meaning::piston)) return Channel::pressure_a;
  return std::nullopt;
}

std::optional<Channel> measured(Meaning quantity, const Reading& reading) {
  switch (quantity) {
    case Meaning::position:
      return Channel::position;
    case Meaning::angle:
      return Channel::angle;
    case Meaning::force:
      return Channel::force;
    case Meaning::torque:
      if (reading.says(Meaning::supply)) return std::nullopt;  // the shaft of a pump
      return Channel::torque;
    case Meaning::pressure:
      return pressure_at(reading);
    case Meaning::acceleration:
      if (reading.says(Meaning::base)) return Channel::base_acceleration;
      if (reading.says(Meaning::payload)) return Channel::payload_acceleration;
      if (!reading.is_named() && !reading.of_unit) return std::nullopt;  // "a" may be anything
      return Channel::acceleration;
    case Meaning::temperature:
      return Channel::temperature;
    default:
      return std::nullopt;
  }
}

/// Returns the channel of a name without a quantity.
std::optional<Channel> without_quantity(const Reading& reading) {
  if (reading.says(Meaning::pilot)) return Channel::pilot_pressure;
  if (reading.says(Meaning::supply) || reading.says(Meaning::tank))
    return reading.says(Meaning::valve) ? std::nullopt : pressure_at(reading);
  if (reading.says(Meaning::valve)) return Channel::command;
  if (reading.says(Meaning::reference)) return Channel::reference;
  if (reading.says(Meaning::command)) return Channel::command;
  if (is_share(reading.unit)) return std::nullopt;
  if (reading.says(Meaning::load)) return Channel::force;
  if (reading.says(Meaning::piston) || reading.says(Meaning::measured)) return Channel::position;
  return std::nullopt;
}

/// Describes a column whose quantity is recognised but that is not a channel.
std::string_view other_of(std::optional<Meaning> quantity, const Reading& reading) {
  if (reading.says(Meaning::error)) return "a control error";
  if (!quantity) return {};
  switch (*quantity) {
    case Meaning::velocity:
      return "a velocity";
    case Meaning::flow:
      return "a flow";
    case Meaning::rotation:
      return "a speed of rotation";
    case Meaning::position:
      return kSpoolPosition;
    default:
      return {};
  }
}

ColumnGuess meaning_of(const Reading& reading) {
  ColumnGuess guess;
  guess.unit = reading.unit;
  guess.is_time = is_time(reading);
  const bool known = std::any_of(reading.tokens.begin(), reading.tokens.end(),
                                 [](const Token& t) { return t.meaning != Meaning::filler; });
  if (guess.is_time || (!known && reading.of_unit != Meaning::temperature)) return guess;
  if (reading.tokens.empty()) return guess;
  const auto quantity = quantity_in(reading);
  // "u_mm" drives a loop on position.
  const bool drives = reading.says(Meaning::reference) || reading.says(Meaning::command) ||
                      (reading.says(Meaning::valve) && reading.of_unit && !reading.is_named());
  const bool of_spool = reading.says(Meaning::spool) && quantity == Meaning::position;
  if (!of_spool && !reading.says(Meaning::error)) {
    if (!quantity)
      guess.channel = without_quantity(reading);
    else if (*quantity == Meaning::pressure && reading.says(Meaning::pilot))
      guess.channel = Channel::pilot_pressure;
    else
      guess.channel = drives ? reference_of(*quantity, reading) : measured(*quantity, reading);
  }
  if (!guess.channel) guess.other = other_of(quantity, reading);
  return guess;
}

/// Returns the unit that is meant by one that is often written for another (may_mean_another):
/// gravity by the "g" of an acceleration, and newton metres by the "nm" of a torque.
std::string meant_unit(const std::string& unit, const Reading& reading) {
  const auto quantity = reading.of_name();
  if (unit == "g" && quantity == Meaning::acceleration) return "gravity";
  if (unit == "nm" && quantity == Meaning::torque) return "N m";
  return unit;
}

/// Adds what the first part of a name says where its M is a moment: "Mext_Nm", "Msoll_kNm".
void read_moment(const std::string& first, std::vector<Token>& tokens) {
  if (!first.starts_with('m') || has(tokens, Meaning::torque)) return;
  const auto rest = joined_words(std::string_view(first).substr(1), false);
  tokens.insert(tokens.begin(), rest.begin(), rest.end());
  tokens.insert(tokens.begin(), {Meaning::torque, true});
}

}  // namespace

bool converts_to(const std::string& unit, std::string_view to) {
  if (unit.empty()) return false;
  try {
    unit_conversion(unit, to);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

ColumnGuess guess_column(const std::string& name, const std::string& unit) {
  std::string own = name;
  Reading reading;
  const auto in_name = unit_in_name(name);
  if (in_name) {
    reading.unit = in_name->unit;
    own.replace(in_name->begin, in_name->end - in_name->begin, " ");
  }
  // Only the last part of a path names the quantity.
  if (own.starts_with('/')) own = own.substr(own.rfind('/') + 1);
  for (const char before : {'!', '.'}) own = own.substr(own.rfind(before) + 1);
  std::vector<std::string> parts = parts_of(own);
  if (parts.size() > 1 && parts[0] == "x" && parts[1] == "value") parts = {"time"};  // LabVIEW
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // "x_r" may be at the right, "r_mm" is a reference. The "X_Axis" of a logger is not a position.
    if (i > 0 && parts[i] == "r") continue;
    if (parts[i] == "x" && i + 1 < parts.size() && parts[i + 1] == "axis") continue;
    // "x_d" is what is desired.
    const bool desired = i + 1 < parts.size() && parts[i] == "x" && parts[i + 1] == "d";
    const auto tokens = tokens_of(desired ? "xd" : parts[i], reading.tokens);
    reading.tokens.insert(reading.tokens.end(), tokens.begin(), tokens.end());
  }
  if (!unit.empty()) {
    const std::string spelled = unit_of_text(unit);
    reading.unit = spelled.empty() ? unit : spelled;
  }
  const bool ends_in_g = !in_name && parts.size() > 1 && parts.back() == "g";
  if (unit.empty() && ends_in_g && reading.of_name() == Meaning::acceleration) reading.unit = "g";
  reading.unit = meant_unit(reading.unit, reading);
  reading.of_unit = quantity_of_unit(reading.unit);
  if (reading.of_unit == Meaning::torque && !parts.empty())
    read_moment(parts.front(), reading.tokens);
  return meaning_of(reading);
}

std::optional<Channel> guess_by_unit(const std::string& unit, std::span<const Channel> taken) {
  constexpr std::array kChannels{
      std::pair<std::string_view, Channel>{"rad", Channel::angle},
      std::pair<std::string_view, Channel>{"m", Channel::position},
      std::pair<std::string_view, Channel>{"m", Channel::reference},
      std::pair<std::string_view, Channel>{"V", Channel::command},
      std::pair<std::string_view, Channel>{"Pa", Channel::pressure_a},
      std::pair<std::string_view, Channel>{"Pa", Channel::pressure_b},
      std::pair<std::string_view, Channel>{"Pa", Channel::supply_pressure},
      std::pair<std::string_view, Channel>{"N", Channel::force},
      std::pair<std::string_view, Channel>{"m/s2", Channel::acceleration},
      std::pair<std::string_view, Channel>{"K", Channel::temperature}};
  for (const auto& [si, channel] : kChannels)
    if (converts_to(unit, si) && std::find(taken.begin(), taken.end(), channel) == taken.end())
      return channel;
  return std::nullopt;
}

}  // namespace rigcal::datasets
