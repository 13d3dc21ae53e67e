#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// A unit found in the name of a column.
struct UnitInName {
  std::string unit;       ///< as UDUNITS spells it: "degC" for "T [C]"
  std::size_t begin = 0;  ///< range of its text in the name, including brackets
  std::size_t end = 0;
  /// Whether the text can only be a unit: it is in brackets, and is not a word like the "in" in "p
  /// (in)".
  bool is_certain = false;
};

/// Finds the unit in the name of a column: "x [mm]", "q (m3/(s Pa))", "pA_bar_03", "M_kN_m". Text
/// in brackets takes priority over text after an underscore or a space.
///
/// @return  std::nullopt if the name contains no unit, or only one that denotes a pure number
std::optional<UnitInName> unit_in_name(std::string_view name);

/// Returns the UDUNITS spelling of a unit: "psi" for "PSI" and "psig", "kgf/cm2" for "kg/cm2", "s"
/// for "seconds since 2026-01-01". Empty if the text is not a unit.
std::string unit_of_text(std::string_view text);

/// Whether a unit is often written for another: "g" for gravity, "nm" for newton metres.
bool may_mean_another(std::string_view unit);

/// Returns the position of the brackets at the end of a name, such as "[mm]" in "x [mm]";
/// std::nullopt if there are none.
std::optional<std::size_t> brackets_at_end(std::string_view name);

}  // namespace rigcal::datasets
