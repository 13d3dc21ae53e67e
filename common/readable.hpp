#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// A readable unit. A value in this unit is the SI value divided by `si`.
struct ReadableUnit {
  std::string name;
  double si = 1.0;
};

/// Writes a unit with its printed symbols: "m3/s" -> "m³/s", "um" -> "µm".
std::string typographic(std::string_view unit);

/// Returns the engineering unit in which a value needs few digits: 6.2e6 Pa -> MPa, 0.0508 m -> mm.
/// Returns the SI unit itself if it has no such multiples. The name of unit "1" is empty.
ReadableUnit readable_unit(double value_si, std::string_view si_unit);

/// Writes a value in its readable unit, with `digits` significant digits: "6.2 MPa", "0.35"; "-" if
/// the value is not finite.
std::string readable(double value_si, std::string_view si_unit, int digits = 6);

}  // namespace rigcal
