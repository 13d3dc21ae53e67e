#pragma once

#include <string>
#include <string_view>

namespace rigcal::report {

/// A unit for people: value in it = SI value / si.
struct ReadableUnit {
  std::string name;
  double si = 1.0;
};

/// A unit as one prints it: "m3/s" -> "m³/s", "um" -> "µm".
std::string typographic(std::string_view unit);

/// The usual engineering unit in which a value is a number of few digits: 6.2e6 Pa -> MPa,
/// 0.0508 m -> mm. Units that have no such relatives stay SI; "1" has an empty name.
ReadableUnit readable_unit(double value_si, std::string_view si_unit);

/// "6.2 MPa", "0.35", "-": `digits` significant digits; "-" where the value is not finite.
std::string readable(double value_si, std::string_view si_unit, int digits = 6);

/// Rounds a value to the last of the two significant digits of its uncertainty (GUM, 7.2.6).
/// Smaller digits are dropped: 0.0004 with 0.1 is "0.00".
///
/// @param uncertainty  standard error, or half width of an interval, in the unit of the value;
///                     above zero
std::string to_uncertainty(double value, double uncertainty);

/// Number with `decimals` decimals, never "-0.00".
std::string fixed(double value, int decimals);

/// Agreement such as rho2 as a fraction with four decimals; "> 0.9999" where these would claim that
/// it is perfect.
std::string agreement_text(double value);

/// "p = 0.012", "p < 0.0001".
std::string p_value_text(double p);

}  // namespace rigcal::report
