#include "datasets/prepare/stated_units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "common/error.hpp"
#include "common/quantity.hpp"
#include "datasets/read/unit_in_name.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kSameFactor = 1e-6;
/// A gain may be rounded, and may include a sensor correction.
constexpr double kSameGain = 0.05;

/// Unit that the file gives for a column.
struct NamedUnit {
  std::string unit;
  bool is_certain = true;
};

std::optional<NamedUnit> named_unit(const ColumnLabel& label) {
  if (!label.unit.empty()) {
    const std::string unit = unit_of_text(label.unit);
    return unit.empty() ? std::nullopt : std::optional(NamedUnit{unit, !may_mean_another(unit)});
  }
  const auto found = unit_in_name(label.name);
  return found ? std::optional(NamedUnit{found->unit, found->is_certain}) : std::nullopt;
}

/// Returns the conversion between two units; std::nullopt if their dimensions differ.
std::optional<UnitConversion> conversion_between(const std::string& from, const std::string& to) {
  try {
    return unit_conversion(from, to);
  } catch (const QuantityError&) {
    return std::nullopt;
  }
}

bool is_same(const UnitConversion& conversion) {
  return std::abs(conversion.scale - 1.0) <= kSameFactor &&
         std::abs(conversion.offset) <= kSameFactor;
}

bool contradicts(const StatedUnit& stated, const NamedUnit& named) {
  const auto conversion = conversion_between(named.unit, stated.unit);
  if (!conversion) {
    // Degrees of a temperature are often written without their scale: "Temp [Grad]".
    if (named.unit == "deg" && conversion_between(stated.unit, "K")) return false;
    const bool is_pure_number = conversion_between(named.unit, "1").has_value();
    return named.is_certain && !stated.gain && !is_pure_number;
  }
  const bool same_scale = std::abs(conversion->scale - 1.0) <= kSameFactor;
  if (is_same(*conversion) || (same_scale && stated.has_offset)) return false;
  const double converted = std::abs(stated.gain.value_or(1.0)) / conversion->scale;
  return !stated.gain || std::abs(converted - 1.0) > kSameGain;
}

bool is_ignored(const StatedUnit& stated, const NamedUnit& named) {
  if (stated.ignored.empty()) return false;
  const std::string ignored = unit_of_text(stated.ignored);
  if (ignored == named.unit) return true;
  const auto conversion = conversion_between(ignored, named.unit);
  return conversion && is_same(*conversion);
}

}  // namespace

void require_stated_unit(const StatedUnit& stated, const std::string& key,
                         const std::filesystem::path& file, const ColumnLabel& label) {
  if (stated.unit.empty()) return;
  const auto named = named_unit(label);
  if (!named || !contradicts(stated, *named) || is_ignored(stated, *named)) return;
  throw InputError(
      {file.string(), label.line, 0},
      fmt::format("{}column '{}' is in {}, but recording.channels.{} says unit = \"{}\" ({}); "
                  "expected unit = \"{}\", a gain that converts it, or ignore_unit = \"{}\" where "
                  "the file is wrong",
                  label.place.empty() ? std::string() : label.place + ": ", label.name, named->unit,
                  key, stated.unit, stated.where.text(), named->unit, named->unit));
}

}  // namespace rigcal::datasets
