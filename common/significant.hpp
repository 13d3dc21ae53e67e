#pragma once

#include <string>

namespace rigcal {

/// Writes the exponent of a number as a power of ten: "7.9e-05" becomes "7.9×10⁻⁵". A number
/// without an exponent is returned as it is.
std::string with_power_of_ten(std::string number);

/// Formats a value with the given number of significant digits. Values from 0.0001 to just below a
/// million have no power of ten: with two digits, 170 becomes "170" rather than "1.7×10²".
std::string significant(double value, int digits);

/// Formats a measured or computed value like significant(), but keeps the zeros after the point:
/// with three digits, 2.9 becomes "2.90".
std::string measured(double value, int digits);

/// Writes a number with `decimals` decimals, never as "-0.00".
std::string fixed(double value, int decimals);

/// Rounds a value to the decimal place of the second significant digit of its uncertainty (GUM,
/// 7.2.6). Smaller digits are dropped: 0.0004 with 0.1 is "0.00".
///
/// @param uncertainty  standard error, or half width of an interval, in the unit of the value;
///                     above zero
std::string to_uncertainty(double value, double uncertainty);

/// Writes a p-value: "p = 0.012", "p < 0.0001".
std::string p_value_text(double p);

}  // namespace rigcal
