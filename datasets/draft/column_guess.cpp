#include "datasets/draft/column_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

namespace rigcal::datasets {
namespace {

constexpr std::array<std::string_view, 28> kUnits{
    "s",   "ms",  "us",  "min", "V",  "mV",  "m", "cm", "mm",   "um",   "in", "bar", "mbar", "Pa",
    "kPa", "MPa", "psi", "N",   "kN", "lbf", "K", "C",  "degC", "degF", "mA", "A",   "inch", "hPa"};

constexpr std::array<std::string_view, 6> kLengths{"m", "cm", "mm", "um", "in", "inch"};

using Words = std::vector<std::string_view>;

const Words kTimeWords{"t", "time", "tout", "timestamp", "zeit", "seconds"};

const std::vector<std::pair<Channel, Words>> kChannelWords{
    {Channel::reference,
     {"ref", "r", "reference", "setpoint", "sp", "target", "desired", "demand", "soll", "xref",
      "xd"}},
    {Channel::command, {"u", "cmd", "command", "valve", "control", "uv", "voltage", "servo"}},
    {Channel::position,
     {"x", "y", "pos", "position", "stroke", "disp", "displacement", "piston", "ist", "xp",
      "lvdt"}},
    {Channel::load_pressure, {"pl", "dp", "loadpressure", "pload", "deltap"}},
    {Channel::pressure_a,
     {"pa", "p1", "pressurea", "pressure1", "chambera", "chamber1", "pcap", "phead", "pbore"}},
    {Channel::pressure_b,
     {"pb", "p2", "pressureb", "pressure2", "chamberb", "chamber2", "prod", "pannulus"}},
    {Channel::supply_pressure, {"ps", "psupply", "supply", "supplypressure", "pp"}},
    {Channel::force, {"f", "force", "load", "loadcell", "fl"}},
    {Channel::temperature, {"temp", "temperature", "toil", "oiltemperature"}}};

/// Words behind which a lone A is a chamber, not amperes.
const Words kChamberWords{"p", "pressure", "chamber", "druck", "kammer"};

/// Parts between underscores, blanks and brackets.
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

/// The unit that a part behind others is, if any: a last "pa" behind a word is no chamber.
std::string unit_of(const std::string& part, bool last, const std::string& before) {
  if (last && part == "pa") return "Pa";
  if (part == "A" && contains(kChamberWords, before)) return {};
  if (std::find(kUnits.begin(), kUnits.end(), part) == kUnits.end()) return {};
  return part == "C" ? "degC" : part;
}

void assign(ColumnGuess& guess, const std::string& word) {
  if (guess.is_time || guess.channel) return;
  guess.is_time = contains(kTimeWords, word);
  for (const auto& [channel, words] : kChannelWords)
    if (!guess.is_time && !guess.channel && contains(words, word)) guess.channel = channel;
}

}  // namespace

ColumnGuess guess_column(const std::string& name) {
  // Of "/run1/x", "Sheet1!x" and "log.signals(2).values" what stands last tells.
  std::string own = name.starts_with('/') ? name.substr(name.rfind('/') + 1) : name;
  for (const char before : {'!', '.'}) own = own.substr(own.rfind(before) + 1);
  const auto parts = parts_of(own);
  ColumnGuess guess;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string unit;
    if (i > 0 && guess.unit.empty())
      unit = unit_of(parts[i], i + 1 == parts.size(), lower(parts[i - 1]));
    if (unit.empty())
      words.push_back(lower(parts[i]));
    else
      guess.unit = unit;
  }
  if (words.size() > 1) assign(guess, words[0] + words[1]);
  for (const std::string& word : words) assign(guess, word);
  // A command in units of length is the reference of a position loop.
  const bool is_length = std::find(kLengths.begin(), kLengths.end(), guess.unit) != kLengths.end();
  if (guess.channel == Channel::command && is_length) guess.channel = Channel::reference;
  return guess;
}

}  // namespace rigcal::datasets
