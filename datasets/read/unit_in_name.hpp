#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// Unit in the name of a column.
struct UnitInName {
  std::string unit;       ///< as UDUNITS spells it: "degC" of "T [C]"
  std::size_t begin = 0;  ///< range of its text in the name, with its brackets
  std::size_t end = 0;
  /// It can only be a unit: it is in brackets, and no word such as the "in" of "p (in)".
  bool is_certain = false;
};

/// Finds the unit in the name of a column: "x [mm]", "q (m3/(s Pa))", "pA_bar_03". Text in brackets
/// has priority over text after an underscore or a blank.
///
/// @return  nothing if the name has no unit, or that of a pure number
std::optional<UnitInName> unit_in_name(std::string_view name);

/// Returns the UDUNITS spelling of a unit: "psi" for "PSI" and "psig", "kgf/cm2" for "kg/cm2", "s"
/// for "seconds since 2026-01-01"; empty if the text is no unit.
std::string unit_of_text(std::string_view text);

/// Start of the brackets that end a name, "[mm]" of "x [mm]"; nothing if there are none.
std::optional<std::size_t> brackets_at_end(std::string_view name);

}  // namespace rigcal::datasets
