#include "datasets/draft/column_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include "common/quantity.hpp"
#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

/// Quantities that a control loop may control: SI unit, and channel of the reference.
using Controlled = std::pair<std::string_view, Channel>;
constexpr std::array kControlled{Controlled{"m", Channel::reference},
                                 Controlled{"N", Channel::force_reference},
                                 Controlled{"Pa", Channel::load_pressure_reference},
                                 Controlled{"m/s2", Channel::acceleration_reference}};

using Words = std::vector<std::string_view>;

const Words kTimeWords{"t",        "time",  "tout",    "timestamp", "zeit",
                       "messzeit", "temps", "elapsed", "seconds",   "x_value"};

const std::vector<std::pair<Channel, Words>> kChannelWords{
    {Channel::reference,
     {"ref", "r", "reference", "setpoint", "sp", "target", "desired", "demand", "dem", "soll",
      "sollwert", "sollweg", "sollposition", "xref", "xsoll", "xd"}},
    {Channel::command,
     {"u", "u1", "cmd", "command", "valve", "control", "uv", "voltage", "servo", "drive", "duty",
      "stellgroesse", "stellgröße", "stellsignal", "ventil", "ventilspannung", "spannung"}},
    {Channel::position,
     {"x", "y", "s", "s1", "pos", "position", "stroke", "disp", "displacement", "piston", "ist",
      "istwert", "istposition", "weg", "kolbenweg", "hub", "xp", "lvdt"}},
    {Channel::angle, {"angle", "theta", "ang", "jointangle", "winkel", "gelenkwinkel"}},
    {Channel::pilot_pressure,
     {"pilot", "ppilot", "pilotpressure", "vorsteuerdruck", "steuerdruck"}},
    {Channel::load_pressure,
     {"pl", "dp", "loadpressure", "pload", "deltap", "lastdruck", "differenzdruck"}},
    {Channel::pressure_a,
     {"pa", "p1", "pressurea", "pressure1", "chambera", "chamber1", "pcap", "phead", "pbore",
      "drucka", "druck1", "kammera"}},
    {Channel::pressure_b,
     {"pb", "p2", "pressureb", "pressure2", "chamberb", "chamber2", "prod", "pannulus", "druckb",
      "druck2", "kammerb"}},
    {Channel::supply_pressure,
     {"ps", "p0", "psupply", "supply", "supplypressure", "pp", "versorgungsdruck", "systemdruck"}},
    {Channel::tank_pressure, {"pt", "ptank", "tank", "tankpressure", "tankdruck"}},
    {Channel::force, {"f", "force", "load", "loadcell", "fl", "kraft"}},
    {Channel::base_acceleration,
     {"accbase", "baseacc", "baseacceleration", "abase", "accground", "groundacc",
      "groundacceleration", "accfoundation", "accframe", "frameacc"}},
    {Channel::acceleration, {"acc", "accel", "acceleration", "accelerometer"}},
    {Channel::force_reference,
     {"refforce", "forceref", "forcereference", "forcesetpoint", "forcecmd", "forcecommand",
      "forcedemand", "fref", "fset", "fsoll"}},
    {Channel::temperature,
     {"temp", "temperature", "toil", "oiltemperature", "temperatur", "öltemperatur"}}};

/// Splits a name at underscores, spaces, brackets, '-' and '/'.
std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '_' || c == ' ' || c == '[' || c == ']' || c == '(' || c == ')' || c == '-' ||
        c == '/')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  std::erase(parts, std::string());
  return parts;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool converts(const std::string& unit, std::string_view to) {
  if (unit.empty()) return false;
  try {
    unit_conversion(unit, to);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

void assign(ColumnGuess& guess, const std::string& word) {
  if (guess.is_time || guess.channel) return;
  guess.is_time = contains(kTimeWords, word);
  for (const auto& [channel, words] : kChannelWords)
    if (!guess.is_time && !guess.channel && contains(words, word)) guess.channel = channel;
}

}  // namespace

ColumnGuess guess_column(const std::string& name) {
  ColumnGuess guess;
  std::string own = name;
  const auto unit = unit_in_name(name);
  if (unit) {
    guess.unit = unit->unit;
    own.replace(unit->begin, unit->end - unit->begin, " ");
  }
  // Only the last part of a path names the quantity.
  if (own.starts_with('/')) own = own.substr(own.rfind('/') + 1);
  for (const char before : {'!', '.'}) own = own.substr(own.rfind(before) + 1);
  std::vector<std::string> words;
  for (const std::string& part : parts_of(own)) words.push_back(lower(part));
  if (words.size() > 1) {
    assign(guess, words[0] + words[1]);
    assign(guess, words[0] + "_" + words[1]);
  }
  for (const std::string& word : words) assign(guess, word);
  // A command in the unit of a controlled quantity is the reference of a control loop.
  if (guess.channel == Channel::command || guess.channel == Channel::reference) {
    for (const auto& [of_loop, reference] : kControlled)
      if (converts(guess.unit, of_loop)) guess.channel = reference;
  }
  return guess;
}

std::optional<Channel> guess_by_unit(const std::string& unit, bool has_position) {
  const auto is_of = [&unit](const char* si) {
    try {
      unit_conversion(unit, si);
      return true;
    } catch (const QuantityError&) {
      return false;
    }
  };
  if (unit.empty()) return std::nullopt;
  if (is_of("rad")) return Channel::angle;
  if (is_of("m")) return has_position ? Channel::reference : Channel::position;
  if (is_of("V")) return Channel::command;
  if (is_of("Pa")) return Channel::pressure_a;
  if (is_of("N")) return Channel::force;
  if (is_of("K")) return Channel::temperature;
  return std::nullopt;
}

}  // namespace rigcal::datasets
