#pragma once

#include <string>

namespace rigcal {

/// A value rounded to so many significant digits, without an exponent from 1 to below a million:
/// "170", where two digits alone would be "1.7e+02".
std::string significant(double value, int digits);

}  // namespace rigcal
