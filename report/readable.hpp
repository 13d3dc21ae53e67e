#pragma once

#include <string>
#include <string_view>

namespace rigcal::report {

/// A unit for people: value in it = SI value / si.
struct ReadableUnit {
  std::string_view name;
  double si = 1.0;
};

/// The usual engineering unit in which a value is a number of few digits: 6.2e6 Pa -> MPa,
/// 0.0508 m -> mm. Units that have no such relatives stay SI; "1" has an empty name.
ReadableUnit readable_unit(double value_si, std::string_view si_unit);

/// A value rounded to so many significant digits, without an exponent from 1 to below a million:
/// "170", where two digits alone would be "1.7e+02".
std::string significant(double value, int digits);

/// "6.2 MPa", "0.35", "-": `digits` significant digits; "-" where the value is not finite.
std::string readable(double value_si, std::string_view si_unit, int digits = 6);

/// "p = 0.012", "p < 0.0001".
std::string p_value_text(double p);

}  // namespace rigcal::report
