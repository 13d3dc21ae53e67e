#pragma once

#include <string>

namespace rigcal {

/// Formats a value with the given number of significant digits. Values from 1 to below a million
/// get no exponent: "170", where two digits would otherwise give "1.7e+02".
std::string significant(double value, int digits);

}  // namespace rigcal
