#pragma once

#include <string>

namespace rigcal {

/// Formats a value with the given number of significant digits. Values from 1 to just below a
/// million have no exponent: with two digits, 170 becomes "170" rather than "1.7e+02".
std::string significant(double value, int digits);

}  // namespace rigcal
