#include "calib/result/fitted_parameter.hpp"

#include <cmath>

namespace rigcal::calib {

using datasets::Scope;

void FittedParameter::name_after(const model::ParameterSpec& spec) {
  name = spec.name;
  key = spec.key;
  symbol = spec.symbol;
  unit = spec.unit;
}

bool FittedParameter::matches(int row, Scope of, const std::string& level_of) const {
  return index == row && scope == of && level.value_or("") == level_of;
}

FittedParameter parameter_in_row(model::PlantKind plant, int index, Scope scope,
                                 const std::string& level) {
  FittedParameter parameter;
  parameter.index = index;
  parameter.name_after(model::parameter_spec(plant, index));
  parameter.scope = scope;
  if (scope != Scope::rig) parameter.level = level;
  return parameter;
}

double undetermined_sd(const std::optional<Range>& ci95, double lower, double upper) {
  const auto [low, high] = ci95.value_or(Range{lower, upper});
  return (high - low) / std::sqrt(12.0);
}

}  // namespace rigcal::calib
