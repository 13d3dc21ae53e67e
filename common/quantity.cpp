#include "common/quantity.hpp"

#include <fmt/format.h>
#include <locale.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>

#include "common/error.hpp"
#include "common/installed_file.hpp"
#include "common/suggest.hpp"

namespace rigcal {
namespace {

/// A unit as powers of basic units (radian counts as one), with the map to their product: basic =
/// scale * value + offset.
struct Unit {
  double scale = 1.0;
  double offset = 0.0;
  std::map<std::string, int> powers;
};

// ---- UDUNITS -------------------------------------------------------------------------------

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeLocale {
  void operator()(locale_t locale) const { freelocale(locale); }
};
using UnitPtr = std::unique_ptr<ut_unit, FreeUnit>;

/// Sets the "C" locale for the calling thread, because UDUNITS reads its database with the locale's
/// strtod.
class PlainLocale {
 public:
  PlainLocale()
      : plain_(newlocale(LC_ALL_MASK, "C", locale_t{})), previous_(uselocale(plain_.get())) {
    if (!plain_) throw std::bad_alloc();  // numbers would be read with another decimal separator
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;
  ~PlainLocale() { uselocale(previous_); }

 private:
  std::unique_ptr<std::remove_pointer_t<locale_t>, FreeLocale> plain_;
  locale_t previous_;
};

void add_power(Unit& unit, const ut_unit* basic, int power) {
  const char* name = ut_get_name(basic, UT_ASCII);
  unit.powers[name == nullptr ? "?" : name] += power;
}

/// Breaks a parsed unit down into a Unit.
constexpr ut_visitor kTakeApart{
    [](const ut_unit* basic, void* result) {
      add_power(*static_cast<Unit*>(result), basic, 1);
      return UT_SUCCESS;
    },
    [](const ut_unit*, int count, const ut_unit* const* basics, const int* powers, void* result) {
      for (int i = 0; i < count; ++i) add_power(*static_cast<Unit*>(result), basics[i], powers[i]);
      return UT_SUCCESS;
    },
    [](const ut_unit*, double scale, const ut_unit* underlying, double offset, void* result) {
      const ut_status status = ut_accept_visitor(underlying, &kTakeApart, result);
      Unit& unit = *static_cast<Unit*>(result);
      unit.offset += unit.scale * scale * offset;
      unit.scale *= scale;
      return status;
    },
    [](const ut_unit*, const ut_unit*, double, void*) { return UT_VISIT_ERROR; },  // dates
    [](const ut_unit*, double, const ut_unit*, void*) { return UT_VISIT_ERROR; },  // logarithms
};

/// A unit name that is added to the database, and its definition.
struct Alias {
  const char* name;
  const char* meaning;
};
constexpr std::array kAliases{
    // UDUNITS takes Hz for 1/s. As one cycle (2 pi rad) per second, it converts to rad/s with a
    // factor of 2 pi, and no longer to 1/s.
    Alias{"Hz", "cycle/s"}, Alias{"hertz", "cycle/s"},
    Alias{"lpm", "L/min"},  Alias{"gpm", "US_liquid_gallon/min"},
    Alias{"rev", "cycle"},  Alias{"deg", "degree"},
    Alias{"Nm", "N m"},
};

/// The unit database. UDUNITS keeps its status in a global, so there is a single instance with a
/// lock.
class UnitSystem {
 public:
  UnitSystem() {
    const PlainLocale plain;
    ut_set_error_message_handler(ut_ignore);  // the default handler writes to stderr
    // Debian's database is where the library expects it. The archive made by scripts/package
    // contains its own.
    const auto own = std::getenv("UDUNITS2_XML_PATH") == nullptr
                         ? installed_file("rigcal/udunits/udunits2.xml")
                         : std::nullopt;
    system_.reset(ut_read_xml(own ? own->c_str() : nullptr));
    if (!system_)
      throw Error(ExitCode::internal,
                  "the unit database of UDUNITS-2 cannot be read (it belongs to the package "
                  "libudunits2-data; UDUNITS2_XML_PATH names another place)");
    for (const auto& [name, meaning] : kAliases) {
      const UnitPtr unit(ut_parse(system_.get(), meaning, UT_UTF8));
      ut_unmap_symbol_to_unit(system_.get(), name, UT_ASCII);
      ut_unmap_name_to_unit(system_.get(), name, UT_ASCII);
      if (!unit || ut_map_symbol_to_unit(name, UT_ASCII, unit.get()) != UT_SUCCESS)
        throw Error(ExitCode::internal,
                    fmt::format("the unit database of UDUNITS-2 does not know '{}'", meaning));
    }
  }

  /// Returns nullopt if the text is not a unit, or is a date or a logarithm.
  std::optional<Unit> parse(const std::string& text) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const PlainLocale plain;
    const UnitPtr parsed(ut_parse(system_.get(), text.c_str(), UT_UTF8));
    Unit unit;
    const ut_status status =
        parsed ? ut_accept_visitor(parsed.get(), &kTakeApart, &unit) : ut_get_status();
    if (status == UT_OS) throw std::bad_alloc();  // not the fault of the text
    if (!parsed || status != UT_SUCCESS) return std::nullopt;
    std::erase_if(unit.powers, [](const auto& entry) { return entry.second == 0; });
    return unit;
  }

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<ut_system, FreeSystem> system_;
};

const UnitSystem& unit_system() {
  static const UnitSystem system;
  return system;
}

// ---- Texts ---------------------------------------------------------------------------------

bool is_space(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Rejects control characters. UDUNITS would read only up to a NUL, and messages would end there.
void refuse_control_characters(std::string_view text) {
  const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\t'; };
  if (std::none_of(text.begin(), text.end(), is_control)) return;
  std::string shown(text);
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  throw QuantityError(
      fmt::format("'{}' contains a control character (here '?'); expected text", shown));
}

/// Whether the text has a number that is not an exponent ("2 mm", "bar 5"), by which UDUNITS would
/// multiply. The "1" in "1/s" does not count.
bool has_factor(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!is_digit(text[i])) continue;
    std::size_t end = i;
    while (end < text.size() && is_digit(text[end])) ++end;
    std::size_t before = i;
    if (before > 0 && (text[before - 1] == '-' || text[before - 1] == '+')) --before;
    const bool leads = before == 0;
    const char previous = leads ? ' ' : text[before - 1];
    const bool two_stars = before > 1 && previous == '*' && text[before - 2] == '*';
    const bool is_exponent =
        !leads && (two_stars || previous == '^' ||
                   std::string_view(" \t*/.(+-,").find(previous) == std::string_view::npos);
    const bool is_one = i == 0 && end == 1 && text[0] == '1' &&
                        (end == text.size() || text[end] == '/' || is_space(text[end]));
    const bool has_fraction = end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1]);
    if ((!is_exponent && !is_one) || has_fraction) return true;
    i = end;
  }
  return false;
}

Unit parse_unit(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return {};
  if (has_factor(text))
    throw QuantityError(fmt::format("'{}' has a number where a unit was expected", text));
  // '@' and "since" shift the origin of a unit; no physical quantity here has such a unit.
  const auto unit = text.find('@') == std::string_view::npos
                        ? unit_system().parse(std::string(text))
                        : std::nullopt;
  if (unit) return *unit;
  const std::string nearest = nearest_name(text, common_units());
  throw QuantityError(
      fmt::format("unknown unit '{}'{}", text,
                  nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

/// Name of a dimension, with an example of a quantity.
struct Kind {
  std::string_view unit;
  std::string_view name;
  std::string_view example;
};
constexpr std::array kKinds{
    Kind{"1", "a dimensionless number", "0.3"},
    Kind{"m", "a length", "50.8 mm"},
    Kind{"m2", "an area", "633 mm2"},
    Kind{"m3", "a volume", "468 cm3"},
    Kind{"m3/s", "a flow", "10 L/min"},
    Kind{"s", "a time", "0.5 s"},
    Kind{"Hz", "a frequency", "0.1 Hz"},
    Kind{"1/s", "a rate", "5 1/s"},
    Kind{"rad", "an angle", "90 deg"},
    Kind{"kg", "a mass", "60 kg"},
    Kind{"kg/m3", "a density", "870 kg/m3"},
    Kind{"N", "a force", "500 N"},
    Kind{"N m", "a torque", "300 N m"},
    Kind{"N m s/rad", "a rotary damping", "3 N m s/rad"},
    Kind{"N m/rad", "a rotary stiffness", "200 N m/rad"},
    Kind{"kg m2", "an inertia", "0.8 kg m2"},
    Kind{"m3/rad", "a displacement per angle", "50 cm3/rev"},
    Kind{"Pa", "a pressure", "6.2 MPa"},
    Kind{"m/s", "a velocity", "0.1 m/s"},
    Kind{"m/s2", "an acceleration", "9.81 m/s2"},
    Kind{"N/m", "a stiffness", "2e5 N/m"},
    Kind{"N s/m", "a damping", "1000 N s/m"},
    Kind{"V", "a voltage", "1.5 V"},
    Kind{"A", "a current", "10 mA"},
    Kind{"K", "a temperature", "38 degC"},
    Kind{"V/m", "a controller gain", "78.74 V/m"},
    Kind{"V s/m", "a derivative gain", "2 V s/m"},
    Kind{"V/(m s)", "an integral gain", "5 V/(m s)"},
    Kind{"m/V", "a valve gain", "0.04 mm/V"},
    Kind{"m3/(s Pa)", "a leakage conductance", "1e-12 m3/(s Pa)"},
};

const Kind* kind_of(const Unit& unit) {
  for (const Kind& kind : kKinds)
    if (parse_unit(kind.unit).powers == unit.powers) return &kind;
  return nullptr;
}

/// Describes what was expected: "a pressure such as "6.2 MPa"".
std::string expected(const Unit& unit, std::string_view text) {
  const Kind* kind = kind_of(unit);
  return kind != nullptr ? fmt::format("{} such as \"{}\"", kind->name, kind->example)
                         : fmt::format("a quantity such as \"1.5 {}\"", text);
}

/// Explains why one unit cannot be converted to the other.
std::string mismatch(const Unit& from, std::string_view from_text, const Unit& to) {
  auto without_radian = from.powers;
  auto to_without_radian = to.powers;
  without_radian.erase("radian");
  to_without_radian.erase("radian");
  if (without_radian == to_without_radian) {
    const bool rates = without_radian == std::map<std::string, int>{{"second", -1}};
    return rates ? fmt::format(
                       "Hz and rad/s count turns (1 Hz = 2 pi rad/s), 1/s does not; '{}' cannot be "
                       "converted to the other",
                       from_text)
                 : fmt::format(
                       "'{}' differs by an angle (rad or Hz), which is a unit of its own "
                       "here",
                       from_text);
  }
  if (from.powers.empty() && (from_text.empty() || from_text == "1")) return "a unit is missing";
  if (from.powers.empty()) return fmt::format("'{}' is the unit of a pure number", from_text);
  const Kind* kind = kind_of(from);
  return kind != nullptr ? fmt::format("'{}' is the unit of {}", from_text, kind->name)
                         : fmt::format("'{}' has another dimension", from_text);
}

/// A factor between units is almost always a short decimal number. Removes the rounding error of
/// its computation, so that "1 kHz" is 1000 Hz and not 999.9999999999999.
double without_rounding(double factor) {
  const std::string digits = fmt::format("{:.13e}", factor);
  double rounded = factor;
  std::from_chars(digits.data(), digits.data() + digits.size(), rounded);
  const double few_ulps = 4.0 * std::numeric_limits<double>::epsilon() * std::abs(factor);
  return std::abs(rounded - factor) <= few_ulps ? rounded : factor;
}

UnitConversion conversion(const Unit& from, const Unit& to) {
  return {without_rounding(from.scale / to.scale), (from.offset - to.offset) / to.scale};
}

/// A number and the text after it.
struct Split {
  double number;
  std::string_view unit;
};

/// @throws QuantityError  if the number is invalid; what() gives the reason
Split split_number(std::string_view text) {
  if (text.empty()) throw QuantityError("the text is empty");
  const bool plus = text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.');
  const char* begin = text.data() + (plus ? 1 : 0);
  const char* end = text.data() + text.size();
  Split result{};
  const auto [rest, error] = std::from_chars(begin, end, result.number);
  if (error == std::errc::invalid_argument)
    throw QuantityError("the number before the unit is missing");
  if (error == std::errc::result_out_of_range)
    throw QuantityError("the number is too large or too small");
  if (!std::isfinite(result.number)) throw QuantityError("the number is not finite");
  if (rest != end && *rest == ',') throw QuantityError("a number has a decimal point, not a comma");
  result.unit = trimmed(std::string_view(rest, static_cast<std::size_t>(end - rest)));
  return result;
}

}  // namespace

const std::vector<std::string>& common_units() {
  static const std::vector<std::string> units{
      "Pa",  "kPa",   "MPa", "GPa", "bar",   "mbar", "psi",   "m",    "mm",    "cm",  "um",
      "kg",  "g",     "s",   "ms",  "min",   "N",    "kN",    "V",    "mV",    "A",   "mA",
      "Hz",  "kHz",   "rad", "deg", "rad/s", "rpm",  "degC",  "K",    "m2",    "mm2", "cm2",
      "m3",  "cm3",   "L",   "mL",  "L/min", "lpm",  "gpm",   "m3/s", "kg/m3", "N/m", "m/s",
      "V/m", "N s/m", "m/V", "%",   "1",     "lbf",  "pound", "inch", "psi"};
  return units;
}

std::string_view dimension_name(std::string_view unit) {
  const Kind* kind = kind_of(parse_unit(unit));
  return kind == nullptr ? std::string_view() : kind->name;
}

UnitConversion unit_conversion(std::string_view from, std::string_view to) {
  refuse_control_characters(from);
  refuse_control_characters(to);
  const Unit source = parse_unit(from);
  const Unit target = parse_unit(to);
  if (source.powers != target.powers)
    throw QuantityError(fmt::format("{}; expected a unit of the dimension of '{}', {}",
                                    mismatch(source, trimmed(from), target), trimmed(to),
                                    expected(target, trimmed(to))));
  return conversion(source, target);
}

double parse_quantity(std::string_view text, std::string_view unit) {
  refuse_control_characters(text);
  const Unit target = parse_unit(unit);
  try {
    const Split split = split_number(trimmed(text));
    const Unit source = parse_unit(split.unit);
    if (source.powers != target.powers) throw QuantityError(mismatch(source, split.unit, target));
    const double value = conversion(source, target)(split.number);
    if (!std::isfinite(value)) throw QuantityError("the number is too large");
    return value;
  } catch (const QuantityError& error) {
    throw QuantityError(
        fmt::format("'{}': {}; expected {}", text, error.what(), expected(target, trimmed(unit))));
  }
}

}  // namespace rigcal
