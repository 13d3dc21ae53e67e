#pragma once

#include <string>
#include <string_view>

namespace rigcal::report {

/// A readable unit. A value in this unit is the SI value divided by `si`.
struct ReadableUnit {
  std::string name;
  double si = 1.0;
};

/// A symbol as it is printed in formulas: "k_sv" is k with the subscript "sv".
struct PrintedSymbol {
  std::string letter, subscript;
  std::string argument;  ///< what follows the subscript: "(0)" or "'"
};
/// Splits a symbol, with Greek letters for their names: "tau_v", "C_leak", "P_L(0)", "K_dtheta".
PrintedSymbol printed_symbol(std::string_view symbol);

/// Writes a unit with its printed symbols: "m3/s" -> "m³/s", "um" -> "µm".
std::string typographic(std::string_view unit);

/// Returns the engineering unit in which a value needs few digits: 6.2e6 Pa -> MPa, 0.0508 m -> mm.
/// Returns the SI unit itself if it has no such multiples. The name of unit "1" is empty.
ReadableUnit readable_unit(double value_si, std::string_view si_unit);

/// Writes a value in its readable unit, with `digits` significant digits: "6.2 MPa", "0.35"; "-" if
/// the value is not finite.
std::string readable(double value_si, std::string_view si_unit, int digits = 6);

/// Writes an agreement such as rho2 as a fraction with four decimals. Writes "> 0.9999" for a value
/// that would round to perfect agreement.
std::string agreement_text(double value);

}  // namespace rigcal::report
