#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal {

inline constexpr double kLitrePerMinute = 1e-3 / 60.0;  ///< m3/s per L/min
inline constexpr double kLitresPerMinute = 60e3;        ///< L/min per m3/s

/// Thrown if a string is not a quantity or has the wrong dimension. what() quotes the string and
/// says what was expected; code that reads a file adds the location.
class QuantityError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Affine map from one unit to another: to = scale * from + offset (offset only for temperatures).
struct UnitConversion {
  double scale = 1.0;
  double offset = 0.0;
  double operator()(double value) const { return scale * value + offset; }
};

/// Returns the conversion between two units of the same dimension, using UDUNITS-2. Hz counts
/// cycles, so it converts to rad/s with a factor of 2 pi. Plain 1/s counts neither cycles nor
/// radians, and converts to neither. "lpm" (L/min) and "gpm" (US gallon/min) are accepted; "1" or
/// "" is dimensionless.
///
/// @throws QuantityError  if a unit is unknown, or if the dimensions differ
UnitConversion unit_conversion(std::string_view from, std::string_view to);

/// Parses a number with a unit, such as "6.2 MPa", and converts it to `unit` (Pa -> 6.2e6). The
/// number must be finite and have a decimal point, whatever the locale.
///
/// @throws QuantityError  if there is no number, no unit although `unit` has a dimension, or if the
///                        dimension is wrong
double parse_quantity(std::string_view text, std::string_view unit);

/// Names of common units, which error messages suggest and the campaign's schema lists.
const std::vector<std::string>& common_units();

/// Name of a unit's dimension, such as "a pressure" for "Pa"; empty if the dimension has no name.
///
/// @throws QuantityError  if the unit is unknown
std::string_view dimension_name(std::string_view unit);

}  // namespace rigcal
