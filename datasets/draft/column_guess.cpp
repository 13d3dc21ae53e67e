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

/// Letters of Latin-1 with accents, without them, as the second byte in UTF-8 has them from 0xA0
/// on. Umlauts of German remain: '.'.
constexpr std::string_view kWithoutAccents = "aaaa...ceeeeiiii.noooo...uuu.y";

/// Lowers the letters of ASCII and, in UTF-8, those of Latin-1 ("\u00d6" too), and takes accents
/// off.
std::string lower(std::string_view text) {
  std::string result;
  for (const char c : text) {
    auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      result += static_cast<char>(std::tolower(byte));
      continue;
    }
    const bool follows_c3 = !result.empty() && static_cast<unsigned char>(result.back()) == 0xC3;
    if (follows_c3 && byte <= 0x9E && byte != 0x97) byte = static_cast<unsigned char>(byte + 0x20);
    const std::size_t letter = byte - std::size_t{0xA0};
    if (follows_c3 && byte >= 0xA0 && letter < kWithoutAccents.size() &&
        kWithoutAccents[letter] != '.')
      result.back() = kWithoutAccents[letter];
    else
      result += static_cast<char>(byte);
  }
  return result;
}

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

/// Splits a name at separators, and letters from digits: "pA_bar_03" into "pA", "bar", "03".
std::vector<std::string> parts_of(std::string_view name) {
  constexpr std::string_view kBetween = "_ []()-/:,;#\"";
  std::vector<std::string> parts(1);
  for (const char c : name) {
    const bool between = kBetween.find(c) != std::string_view::npos;
    const bool changes =
        !parts.back().empty() && is_decimal_digit(c) != is_decimal_digit(parts.back().back());
    if (between || changes) parts.emplace_back();
    if (!between) parts.back() += c;
  }
  std::erase(parts, std::string());
  return parts;
}

/// Splits joined words at their capitals: "rActPos" into "r", "Act", "Pos", and "FIst" into "F",
/// "Ist".
std::vector<std::string> at_capitals(std::string_view part) {
  std::vector<std::string> pieces(1);
  for (std::size_t i = 0; i < part.size(); ++i) {
    const bool begins =
        is_capital(part[i]) && i > 0 &&
        (!is_capital(part[i - 1]) || (i + 1 < part.size() && !is_capital(part[i + 1])));
    if (begins) pieces.emplace_back();
    pieces.back() += part[i];
  }
  return pieces;
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

/// Returns the meaning of a text without capitals: words, or a symbol with words or a place joined
/// to it ("xref", "pa").
std::vector<Token> tokens_of_lower(std::string_view part, std::span<const Token> before) {
  if (const auto place = symbol_in(pressure_places(), part);
      place && has(before, Meaning::pressure))
    return {{*place}};
  if (const auto symbol = symbol_in(quantity_symbols(), part)) return {{*symbol, true}};
  // "ax" is an acceleration unless a word names another quantity: "ax1_pos".
  if (part == "ax" || part == "ay" || part == "az") return {{Meaning::acceleration, true}};
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

/// Whether a piece before a capital is the type of a variable. "fSoll" may be a force, so the name
/// must state its quantity.
bool is_type_prefix(std::string_view piece, std::span<const Token> behind) {
  const auto types = type_prefixes();
  if (std::find(types.begin(), types.end(), piece) == types.end()) return false;
  return std::any_of(behind.begin(), behind.end(), [](const Token& token) {
    return !token.is_symbol && (is_quantity(token.meaning) || token.meaning == Meaning::valve ||
                                token.meaning == Meaning::supply || token.meaning == Meaning::tank);
  });
}

/// Returns the meaning of a part of a name, whose words may be joined with or without capitals.
std::vector<Token> tokens_of(const std::string& part, std::span<const Token> before) {
  const std::string small = lower(part);
  const auto pieces = at_capitals(part);
  if (pieces.size() < 2 || !meanings_of(small).empty()) return tokens_of_lower(small, before);
  std::vector<Token> all(before.begin(), before.end());
  std::vector<Token> behind_first;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto tokens = tokens_of_lower(lower(pieces[i]), all);
    all.insert(all.end(), tokens.begin(), tokens.end());
    if (i > 0) behind_first.insert(behind_first.end(), tokens.begin(), tokens.end());
  }
  if (is_type_prefix(pieces.front(), behind_first)) return behind_first;
  const std::vector<Token> split(all.begin() + static_cast<std::ptrdiff_t>(before.size()),
                                 all.end());
  const auto whole = tokens_of_lower(small, before);
  return whole.size() > split.size() ? whole : split;
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

/// Whether the column is the position of the valve's spool. The valve's signal is a voltage or a
/// current.
bool is_of_spool(const Reading& reading, std::optional<Meaning> quantity) {
  if (!reading.says(Meaning::spool)) return false;
  return quantity == Meaning::position ||
         (!quantity && reading.says(Meaning::measured) && !reading.says(Meaning::electric));
}

std::optional<Meaning> quantity_in(const Reading& reading) {
  if (reading.of_unit && *reading.of_unit != Meaning::time) return reading.of_unit;
  const auto quantity = reading.of_name();
  // "y_%" may be the spool as well as the piston.
  if (is_share(reading.unit) && !reading.is_named()) return std::nullopt;
  return quantity;
}

bool is_time(const Reading& reading) {
  if (reading.of_unit && *reading.of_unit != Meaning::time) return false;
  const auto known = std::find_if(reading.tokens.begin(), reading.tokens.end(), [](const Token& t) {
    return t.meaning != Meaning::filler && t.meaning != Meaning::measured;
  });
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
  if (reading.says(Meaning::reference))
    return reading.says(Meaning::spool) ? Channel::command : Channel::reference;
  if (reading.says(Meaning::command)) return Channel::command;
  if (is_share(reading.unit)) return std::nullopt;
  if (reading.says(Meaning::load)) return Channel::force;
  if (reading.says(Meaning::piston) || reading.says(Meaning::measured)) return Channel::position;
  return std::nullopt;
}

/// Whether a column has the difference between a reference and what was measured.
bool is_difference(const Reading& reading, std::optional<Meaning> quantity) {
  const bool moves = quantity == Meaning::position || quantity == Meaning::angle;
  return reading.says(Meaning::error) || (moves && reading.says(Meaning::difference));
}

/// Whether a force or torque acts from outside. A load cell, which says "load" alone, is part of
/// the rig.
bool acts_from_outside(std::optional<Channel> channel, const Reading& reading) {
  if (channel != Channel::force && channel != Channel::torque) return false;
  if (reading.says(Meaning::external)) return true;
  const bool by_name = reading.says(Meaning::force) || reading.says(Meaning::torque);
  return by_name && reading.says(Meaning::load) && !reading.says(Meaning::measured);
}

/// Describes a column whose quantity is recognised but that is not a channel.
std::string_view other_of(std::optional<Meaning> quantity, const Reading& reading) {
  if (is_difference(reading, quantity)) return "a control error";
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
  if (reading.tokens.empty() || reading.of_unit == Meaning::time) return guess;
  const auto quantity = quantity_in(reading);
  // "u_mm" drives a loop on position.
  const bool drives = reading.says(Meaning::reference) || reading.says(Meaning::command) ||
                      (reading.says(Meaning::valve) && reading.of_unit && !reading.is_named());
  const bool of_spool = is_of_spool(reading, quantity);
  if (!of_spool && !is_difference(reading, quantity)) {
    if (!quantity)
      guess.channel = without_quantity(reading);
    else if (*quantity == Meaning::pressure && reading.says(Meaning::pilot))
      guess.channel = Channel::pilot_pressure;
    else
      guess.channel = drives ? reference_of(*quantity, reading) : measured(*quantity, reading);
  }
  if (!guess.channel) guess.other = of_spool ? kSpoolPosition : other_of(quantity, reading);
  guess.is_external_load = acts_from_outside(guess.channel, reading);
  return guess;
}

/// Returns the unit that is meant by one that is often written for another (may_mean_another):
/// gravity by the "g" of an acceleration, newton metres by the "nm" of a torque, and degrees
/// Celsius by the "grad" of a temperature.
std::string meant_unit(const std::string& unit, const Reading& reading) {
  const auto quantity = reading.of_name();
  if (unit == "g" && quantity == Meaning::acceleration) return "gravity";
  if (unit == "nm" && quantity == Meaning::torque) return "N m";
  if (unit == "deg" && quantity == Meaning::temperature) return "degC";
  return unit;
}

/// Whether a name is that of a force, and the "m" behind its "N" has another meaning: "F_N_m",
/// where m may be a place or "measured".
bool is_force_with_suffix(const UnitInName& unit, const std::string& name) {
  const std::string_view text = std::string_view(name).substr(unit.begin, unit.end - unit.begin);
  if (!unit.unit.ends_with("N m") || !text.ends_with("N_m")) return false;
  const auto parts = parts_of(std::string_view(name).substr(0, unit.begin));
  std::vector<Token> tokens;
  for (const std::string& part : parts) {
    const auto more = tokens_of(part, tokens);
    tokens.insert(tokens.end(), more.begin(), more.end());
  }
  return has(tokens, Meaning::force) && !has(tokens, Meaning::torque);
}

/// Adds what the first part of a name says where its M is a moment: "Mext_Nm", "Msoll_kNm".
void read_moment(const std::string& first, std::vector<Token>& tokens) {
  if (!first.starts_with('m') || has(tokens, Meaning::torque)) return;
  const auto rest = joined_words(std::string_view(first).substr(1), false);
  tokens.insert(tokens.begin(), rest.begin(), rest.end());
  tokens.insert(tokens.begin(), {Meaning::torque, true});
}

/// Returns the last part of a path, which alone names the quantity: "x" of "/run1/x", "Sheet1!x"
/// and "log.x". A point with nothing but a blank behind it ends an abbreviation: "Pos. Soll".
std::string last_of_path(std::string path) {
  if (path.starts_with('/')) path = path.substr(path.rfind('/') + 1);
  path = path.substr(path.rfind('!') + 1);
  for (std::size_t point = path.size(); (point = path.find_last_of('.', point)) != path.npos;) {
    if (point + 1 < path.size() && path[point + 1] != ' ') return path.substr(point + 1);
    path[point] = ' ';
  }
  return path;
}

/// Whether a part is the place of the pressure behind it: "A-Druck", "T pressure". In "p Druck A"
/// and "P pressure 2" it is not.
bool is_place_before(const std::vector<std::string>& parts, std::size_t i) {
  constexpr std::string_view kPorts = "abpt";
  const std::string part = lower(parts[i]);
  if (part.size() != 1 || kPorts.find(part[0]) == std::string_view::npos) return false;
  if (i + 1 >= parts.size() || !has(tokens_of(parts[i + 1], {}), Meaning::pressure)) return false;
  return i + 2 >= parts.size() || !symbol_in(pressure_places(), lower(parts[i + 2]));
}

/// Adds what the parts of a name say.
void read_parts(const std::vector<std::string>& parts, std::vector<Token>& tokens) {
  const auto is = [&](std::size_t i, std::string_view text) {
    return i < parts.size() && lower(parts[i]) == text;
  };
  if (is(0, "x") && is(1, "value")) {  // LabVIEW
    tokens.push_back({Meaning::time});
    return;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // "x_r" may be at the right, "r_mm" is a reference. The "X_Axis" of a logger is not a position.
    if (i > 0 && is(i, "r")) continue;
    if (is(i, "x") && is(i + 1, "axis")) continue;
    // "x_d" is what is desired.
    const bool desired = is(i, "x") && is(i + 1, "d");
    if (is_place_before(parts, i)) {
      tokens.push_back({*symbol_in(pressure_places(), lower(parts[i]))});
      continue;
    }
    const auto more = tokens_of(desired ? "xd" : parts[i], tokens);
    tokens.insert(tokens.end(), more.begin(), more.end());
  }
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
  auto in_name = unit_in_name(name);
  if (in_name && is_force_with_suffix(*in_name, name)) {
    in_name->unit.resize(in_name->unit.size() - std::string_view(" m").size());
    in_name->end -= std::string_view("_m").size();
  }
  if (in_name) {
    reading.unit = in_name->unit;
    own.replace(in_name->begin, in_name->end - in_name->begin, " ");
  }
  const std::vector<std::string> parts = parts_of(last_of_path(own));
  read_parts(parts, reading.tokens);
  if (!unit.empty()) {
    const std::string spelled = unit_of_text(unit);
    reading.unit = spelled.empty() ? unit : spelled;
  }
  const bool ends_in_g = !in_name && parts.size() > 1 && lower(parts.back()) == "g";
  if (unit.empty() && ends_in_g && reading.of_name() == Meaning::acceleration) reading.unit = "g";
  reading.unit = meant_unit(reading.unit, reading);
  reading.of_unit = quantity_of_unit(reading.unit);
  const bool is_moment = reading.of_unit == Meaning::torque ||
                         (reading.unit.empty() && reading.says(Meaning::external) &&
                          !parts.empty() && parts.front() == "M");
  if (is_moment && !parts.empty()) read_moment(lower(parts.front()), reading.tokens);
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
