#pragma once

#include <string_view>

namespace rigcal::report {

/// A unit of the model as a product of powers of SI base units.
struct BaseUnits {
  std::string_view unit;  ///< spelled as in ParameterSpec
  int kg = 0;
  int m = 0;
  int s = 0;
  int A = 0;
  int rad = 0;
  int K = 0;
};

/// @throws std::invalid_argument  if the table does not contain the unit
const BaseUnits& base_units(std::string_view unit);

}  // namespace rigcal::report
