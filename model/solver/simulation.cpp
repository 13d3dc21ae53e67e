#include "model/solver/simulation.hpp"

#include <stdexcept>

namespace rigcal::model {

void SimulationOptions::validate() const {
  const auto require = [](bool condition, const char* message) {
    if (!condition) throw std::invalid_argument(std::string("simulate: ") + message);
  };
  require(tolerance > 0.0 && tolerance < 0.1, "tolerance must be between 0 and 0.1");
  require(sensitivity_looseness > 0.0, "sensitivity_looseness must be positive");
  require(max_steps > 0, "max_steps must be positive");
  require(max_seconds > 0.0, "max_seconds must be positive");
}

}  // namespace rigcal::model
