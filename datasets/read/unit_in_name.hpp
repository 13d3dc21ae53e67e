#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// A unit that stands in the name of a column.
struct UnitInName {
  std::string unit;       ///< as UDUNITS knows it: "degC" of "T [C]"
  std::size_t begin = 0;  ///< where its text stands in the name, with its brackets
  std::size_t end = 0;
  /// It can be nothing but a unit: in brackets, and no word such as the "in" of "p (in)".
  bool is_certain = false;
};

/// The unit that the name of a column tells: "x [mm]", "q (m3/(s Pa))", "pA_bar_03". What stands in
/// brackets counts before what stands behind an underscore or a blank.
///
/// @return  nothing if the name tells no unit, or that of a pure number
std::optional<UnitInName> unit_in_name(std::string_view name);

/// What UDUNITS calls the unit that a text names, "psi" of "PSI" and "psig", "kgf/cm2" of "kg/cm2",
/// "s" of "seconds since 2026-01-01"; empty if it is none.
std::string unit_of_text(std::string_view text);

/// Where the brackets begin that end the name of a column, "[mm]" of "x [mm]"; nothing if none do.
std::optional<std::size_t> brackets_at_end(std::string_view name);

}  // namespace rigcal::datasets
