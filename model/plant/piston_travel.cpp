#include "model/plant/piston_travel.hpp"

#include "model/plant/linkage.hpp"

namespace rigcal::model {

PistonTravel<double> piston_travel(const ParameterValues& values, double angle_rad) {
  LinkageParameters<double> parameters;
  const auto& fields = LinkagePlant::fields<double>();
  for (std::size_t i = 0; i < fields.size(); ++i)
    parameters.*(fields[i].member) = values.value.at(i);
  const LinkagePlant::Coefficients<double> p(parameters);
  return {LinkagePlant::travel(angle_rad, p), LinkagePlant::lever(angle_rad, p),
          LinkagePlant::lever_slope(angle_rad, p)};
}

}  // namespace rigcal::model
