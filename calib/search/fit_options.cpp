#include "calib/search/fit_options.hpp"

#include <stdexcept>
#include <string>

namespace rigcal::calib {

void FitOptions::validate() const {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(std::string("FitOptions: ") + message);
  };
  require(starts >= 1, "starts must be at least 1");
  require(further_starts >= 0, "further_starts must not be negative");
  require(threads >= 1, "threads must be at least 1");
  require(max_iterations >= 0, "max_iterations must not be negative");
  require(bootstrap >= 0, "bootstrap must not be negative");
  require(posterior >= 0, "posterior must not be negative");
  require(!max_evaluations || *max_evaluations > 0, "max_evaluations must be positive");
  require(!max_seconds || *max_seconds > 0.0, "max_seconds must be positive");
}

}  // namespace rigcal::calib
