#include "calib/result/fitted_parameter.hpp"

namespace rigcal::calib {

std::string_view to_string(Identifiability identifiability) {
  switch (identifiability) {
    case Identifiability::identified:
      return "identified";
    case Identifiability::weak:
      return "weak";
    case Identifiability::bounded:
      return "bounded";
    case Identifiability::not_identifiable:
      return "not_identifiable";
  }
  return "";
}

std::string_view to_string(IntervalSource source) {
  switch (source) {
    case IntervalSource::none:
      return "none";
    case IntervalSource::standard_error:
      return "standard_error";
    case IntervalSource::robust_standard_error:
      return "robust_standard_error";
  }
  return "";
}

}  // namespace rigcal::calib
