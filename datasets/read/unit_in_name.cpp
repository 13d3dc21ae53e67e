#include "datasets/read/unit_in_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

#include "common/quantity.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::array<std::string_view, 39> kUnits{
    "s",   "ms",   "us",   "min",  "V",   "mV",  "m",    "cm",  "mm",  "um",  "%",    "lpm", "in",
    "bar", "mbar", "Pa",   "kPa",  "MPa", "psi", "N",    "kN",  "daN", "lbf", "kgf",  "gpm", "rpm",
    "K",   "C",    "degC", "degF", "mA",  "A",   "inch", "hPa", "deg", "rad", "mrad", "mil", "kNm"};

/// Units that another case would change: "MN" is no millinewton.
constexpr std::array<std::string_view, 7> kExactUnits{"MN", "mN", "mNm", "MNm", "Nm", "daNm", "nm"};

/// Numerators and denominators of units that names split: "v_mm_s", "a_m_s2", "Q_l/min",
/// "p_N/mm2".
struct SplitUnit {
  std::span<const std::string_view> above;
  std::span<const std::string_view> below;
  std::string_view between;  ///< "/", or " " between the factors of a moment
};
constexpr std::array<std::string_view, 10> kMoving{
    "m", "mm", "cm", "um", "\u00b5m", "inch", "deg", "\u00b0", "rad", "mrad"};  // "in" is a word
constexpr std::array<std::string_view, 5> kPerTime{"s", "sec", "s2", "s^2", "s\u00b2"};
constexpr std::array<std::string_view, 2> kLitres{"l", "L"};
constexpr std::array<std::string_view, 1> kPerMinute{"min"};
constexpr std::array<std::string_view, 3> kTurns{"1", "U", "rev"};
constexpr std::array<std::string_view, 6> kVolumes{"m3",      "dm3",      "cm3",
                                                   "m\u00b3", "dm\u00b3", "cm\u00b3"};
constexpr std::array<std::string_view, 4> kPerSpan{"s", "sec", "min", "h"};
constexpr std::array<std::string_view, 5> kForces{"N", "kN", "daN", "MN", "kgf"};
constexpr std::array<std::string_view, 4> kPerArea{"mm2", "cm2", "mm\u00b2", "cm\u00b2"};
constexpr std::array<std::string_view, 1> kMetres{"m"};
constexpr std::array<std::string_view, 3> kPounds{"lb", "lbf", "lbs"};
constexpr std::array<std::string_view, 3> kFeet{"ft", "in", "inch"};
constexpr std::array<std::string_view, 2> kLeadingFeet{"ft", "inch"};  // "force in lbs"
constexpr std::array kSplitUnits{
    SplitUnit{kMoving, kPerTime, "/"},  SplitUnit{kLitres, kPerMinute, "/"},
    SplitUnit{kTurns, kPerMinute, "/"}, SplitUnit{kVolumes, kPerSpan, "/"},
    SplitUnit{kForces, kPerArea, "/"},  SplitUnit{kForces, kMetres, " "},
    SplitUnit{kPounds, kFeet, " "},     SplitUnit{kLeadingFeet, kPounds, " "}};

/// Common spellings of units, in lower case, with the units that they mean.
constexpr std::array kSpellings{std::pair<std::string_view, std::string_view>{"c", "degC"},
                                std::pair<std::string_view, std::string_view>{"100ns", "100 ns"},
                                std::pair<std::string_view, std::string_view>{"deg c", "degC"},
                                std::pair<std::string_view, std::string_view>{"deg f", "degF"},
                                std::pair<std::string_view, std::string_view>{"psig", "psi"},
                                std::pair<std::string_view, std::string_view>{"psia", "psi"},
                                std::pair<std::string_view, std::string_view>{"barg", "bar"},
                                std::pair<std::string_view, std::string_view>{"bara", "bar"},
                                std::pair<std::string_view, std::string_view>{"bar(g)", "bar"},
                                std::pair<std::string_view, std::string_view>{"bar(a)", "bar"},
                                std::pair<std::string_view, std::string_view>{"kg/cm2", "kgf/cm2"},
                                std::pair<std::string_view, std::string_view>{"kg/cm^2", "kgf/cm2"},
                                std::pair<std::string_view, std::string_view>{"lbs", "lbf"},
                                std::pair<std::string_view, std::string_view>{"kp", "kgf"},
                                std::pair<std::string_view, std::string_view>{"ncm", "N cm"},
                                std::pair<std::string_view, std::string_view>{"nmm", "N mm"},
                                std::pair<std::string_view, std::string_view>{"ft lb", "ft lbf"},
                                std::pair<std::string_view, std::string_view>{"ft lbs", "ft lbf"},
                                std::pair<std::string_view, std::string_view>{"lb ft", "ft lbf"},
                                std::pair<std::string_view, std::string_view>{"lbs ft", "ft lbf"},
                                std::pair<std::string_view, std::string_view>{"in lb", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"in lbs", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"in lbf", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"lb in", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"lbs in", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"lbf in", "inch lbf"},
                                std::pair<std::string_view, std::string_view>{"ips", "inch/s"},
                                std::pair<std::string_view, std::string_view>{"u/min", "rpm"},
                                std::pair<std::string_view, std::string_view>{"1/min", "rpm"},
                                std::pair<std::string_view, std::string_view>{"rev/min", "rpm"},
                                std::pair<std::string_view, std::string_view>{"grad", "deg"},
                                std::pair<std::string_view, std::string_view>{"pct", "%"},
                                std::pair<std::string_view, std::string_view>{"percent", "%"},
                                std::pair<std::string_view, std::string_view>{"prozent", "%"}};

/// Those spellings, in lower case, that are units behind an underscore too.
constexpr std::array<std::string_view, 9> kUsualSpellings{
    "psig", "psia", "barg", "bara", "lbs", "grad", "pct", "percent", "prozent"};

/// After one of these words, an isolated A means a chamber, not amperes.
constexpr std::array<std::string_view, 17> kChamberWords{
    "p",       "pressure", "chamber", "druck",    "kammer",  "port",         "side",
    "seite",   "press",    "prs",     "pression", "presion", "presi\u00f3n", "pressione",
    "chambre", "camara",   "camera"};

/// Units that are also words, or names of chambers and gauges.
constexpr std::array<std::string_view, 6> kWords{"in", "min", "A", "at", "h", "d"};

template <typename List>
bool is_among(const List& list, std::string_view text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string_view without_spaces(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Returns a text with spaces for what joins the factors of a unit: "ft lb" for "ft-lb".
std::string with_spaces(std::string text) {
  for (const std::string_view sign : {"-", "*", "\u00b7"})
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at))
      text.replace(at, sign.size(), " ");
  return text;
}

bool is_unit(std::string_view text) {
  try {
    unit_conversion(text, text);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

/// Whether a unit denotes a pure number, such as "1" or "-".
bool is_one(const std::string& unit) {
  try {
    return unit_conversion(unit, "1").scale == 1.0;
  } catch (const QuantityError&) {
    return false;
  }
}

/// Returns the index of the bracket that closes the one at `open`.
std::size_t closing(std::string_view name, std::size_t open) {
  const char left = name[open];
  const char right = left == '[' ? ']' : ')';
  int depth = 0;
  for (std::size_t i = open; i < name.size(); ++i) {
    if (name[i] == left) ++depth;
    if (name[i] == right && --depth == 0) return i;
  }
  return std::string_view::npos;
}

/// Part of a name between underscores, spaces and brackets.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Part> name_parts(std::string_view name) {
  constexpr std::string_view kBetween = "_ []()-/";
  std::vector<Part> parts;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (kBetween.find(name[i]) != std::string_view::npos) continue;
    const bool continues = !parts.empty() && parts.back().end == i;
    if (!continues) parts.push_back({i, i});
    parts.back().end = i + 1;
  }
  return parts;
}

std::string_view text_of(std::string_view name, const Part& part) {
  return name.substr(part.begin, part.end - part.begin);
}

bool is_chamber(std::string_view unit, std::string_view before) {
  return unit == "A" && is_among(kChamberWords, lower_case(before));
}

std::optional<UnitInName> in_brackets(std::string_view name) {
  std::optional<UnitInName> found;
  for (std::size_t open = 1; open < name.size(); ++open) {
    if (name[open] != '[' && name[open] != '(') continue;
    const std::size_t close = closing(name, open);
    if (close == std::string_view::npos) continue;
    const std::string_view inside = without_spaces(name.substr(open + 1, close - open - 1));
    const std::string_view last = without_spaces(name.substr(0, open));
    const auto before = name_parts(last);
    const std::string_view word =
        before.empty() ? last
                       : last.substr(before.back().begin, before.back().end - before.back().begin);
    const std::string unit = unit_of_text(inside);
    // A single letter, such as the "g" of a gauge pressure, must be a common unit.
    const bool is_letter =
        inside.size() == 1 && std::isalpha(static_cast<unsigned char>(inside[0])) != 0;
    const bool is_usual = !is_letter || is_among(kUnits, unit);
    if (!unit.empty() && is_usual && !is_one(unit) && !is_chamber(inside, word))
      found = UnitInName{
          unit, open, close + 1,
          may_mean_another(unit) ? false : name[open] == '[' || !is_among(kWords, inside)};
    open = close;
  }
  return found;
}

/// Returns the position at which the last part of "/run1/x", "Sheet1!x" or "log.signals(2).values"
/// begins.
std::size_t begin_of_last(std::string_view path) {
  std::size_t begin = path.starts_with('/') ? path.rfind('/') + 1 : 0;
  for (const char before : {'!', '.'})
    if (const std::size_t at = path.rfind(before); at != std::string_view::npos)
      begin = std::max(begin, at + 1);
  return begin;
}

bool is_number(std::string_view name, const Part& part) {
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(part.begin),
                     name.begin() + static_cast<std::ptrdiff_t>(part.end),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Returns the unit that a part of a name and the one behind it spell together, such as "mm/s" for
/// "mm" and "s"; empty if they do not. A unit ends the name, but for a number.
std::string joined_unit(std::string_view name, const std::vector<Part>& parts, std::size_t i) {
  if (i + 1 >= parts.size()) return {};
  if (i + 2 < parts.size() && !is_number(name, parts[i + 2])) return {};
  const std::string_view above = text_of(name, parts[i]);
  const std::string_view below = text_of(name, parts[i + 1]);
  for (const SplitUnit& split : kSplitUnits) {
    if (!is_among(split.above, above) || !is_among(split.below, below)) continue;
    std::string unit = fmt::format("{}{}{}", above == "l" ? "L" : above, split.between, below);
    std::erase(unit, '^');
    return unit_of_text(unit);
  }
  return {};
}

/// Whether a name has only capitals, so that the case of its units is not significant.
bool is_in_capitals(std::string_view name) {
  return std::none_of(name.begin(), name.end(),
                      [](unsigned char c) { return std::islower(c) != 0; });
}

/// Whether a part of a name has a sign that only units have: "\u00b5m", "\u00b0", "N\u00b7m".
bool has_sign_of_units(std::string_view part) {
  constexpr std::array<std::string_view, 7> kSigns{"\u00b5", "\u03bc", "\u00b0", "\u00b7",
                                                   "\u00b2", "\u00b3", "*"};
  return std::any_of(kSigns.begin(), kSigns.end(), [part](std::string_view sign) {
    return part.find(sign) != std::string_view::npos;
  });
}

/// Returns the unit that a part of a name is; empty if it is none, or may as well be a word.
std::string usual_unit(std::string_view part, bool in_capitals) {
  const bool known = is_among(kUnits, part) || is_among(kExactUnits, part) || part == "pa" ||
                     is_among(kUsualSpellings, lower_case(part)) || has_sign_of_units(part);
  if (known) return part == "pa" ? "Pa" : unit_of_text(part);
  if (!in_capitals || part.size() < 2) return {};
  const std::string unit = unit_of_text(part);
  return is_among(kUnits, unit) ? unit : std::string();
}

/// Finds a moment whose factors a point joins, as in "M_kN.m". Elsewhere a point ends a path.
std::optional<UnitInName> pointed_moment(std::string_view name) {
  for (const std::string_view force : kForces) {
    const std::string text = fmt::format("{}.m", force);
    if (!name.ends_with(text) || name.size() <= text.size()) continue;
    const std::size_t begin = name.size() - text.size();
    if (name[begin - 1] == '_' || name[begin - 1] == ' ')
      return UnitInName{fmt::format("{} m", force), begin, name.size(), false};
  }
  return std::nullopt;
}

/// Returns the last unit with the highest priority. A "pa" at the end of a name counts as a unit. A
/// unit that is also a word counts only if nothing but a number follows, unlike the "in" of
/// "duty_in_pct".
std::optional<UnitInName> behind_a_word(std::string_view name) {
  if (const auto moment = pointed_moment(name)) return moment;
  const std::size_t first = begin_of_last(name);
  std::vector<Part> parts = name_parts(name.substr(first));
  for (Part& part : parts) part = {part.begin + first, part.end + first};
  const bool in_capitals = is_in_capitals(name.substr(first));
  std::optional<UnitInName> found;
  int most = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (const std::string joined = joined_unit(name, parts, i); !joined.empty())
      return UnitInName{joined, parts[i].begin, parts[i + 1].end, false};
    const std::string_view text = text_of(name, parts[i]);
    const bool ends = i + 1 == parts.size();
    const std::string unit = usual_unit(text, in_capitals);
    const bool is_pascal = unit == "Pa" && text != "Pa";
    const bool is_word = is_among(kWords, unit);
    if (unit.empty() || is_chamber(text, text_of(name, parts[i - 1])) || (is_pascal && !ends) ||
        (is_word && !ends && !is_number(name, parts[i + 1])))
      continue;
    // A unit that may also be a word or a name has the lowest priority, as in "position in mm".
    const int weight = is_pascal || is_word ? 0 : text.size() == 1 ? 1 : 2;
    if (weight < most) continue;
    most = weight;
    found = UnitInName{unit, parts[i].begin, parts[i].end, false};
  }
  return found;
}

}  // namespace

bool may_mean_another(std::string_view unit) { return unit == "g" || unit == "nm"; }

std::string unit_of_text(std::string_view text) {
  text = without_spaces(text.substr(0, text.find(" since ")));
  if (text.empty()) return {};
  if (text == "Nm" || text == "NM") return "N m";  // nanometres are "nm"
  if (is_among(kExactUnits, text)) return std::string(text);
  const std::string small = lower_case(text);
  for (const auto& [spelling, unit] : kSpellings)
    if ((small == spelling || with_spaces(small) == spelling) && (text.size() > 1 || text == "C"))
      return std::string(unit);
  if (is_among(kUnits, text)) return std::string(text);
  for (const std::string_view unit : kUnits)
    if (lower_case(unit) == small && (text.size() > 1 || text == "S" || text == "M"))
      return std::string(unit);
  return is_unit(text) ? std::string(text) : std::string();
}

std::optional<UnitInName> unit_in_name(std::string_view name) {
  const auto found = in_brackets(name);
  return found ? found : behind_a_word(name);
}

std::optional<std::size_t> brackets_at_end(std::string_view name) {
  if (name.empty() || (name.back() != ']' && name.back() != ')')) return std::nullopt;
  const char close = name.back();
  const char open = close == ']' ? '[' : '(';
  int depth = 0;
  for (std::size_t i = name.size(); i-- > 0;) {
    if (name[i] == close) ++depth;
    if (name[i] == open && --depth == 0) return i;
  }
  return std::nullopt;
}

}  // namespace rigcal::datasets
