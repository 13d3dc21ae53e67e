#include "calib/result/search_report.hpp"

namespace rigcal::calib {

std::string_view to_string(StoppedIn stage) {
  switch (stage) {
    case StoppedIn::nothing:
      break;
    case StoppedIn::starts:
      return "starts";
    case StoppedIn::validation:
      return "validation";
    case StoppedIn::bootstrap:
      return "bootstrap";
    case StoppedIn::profiles:
      return "profiles";
    case StoppedIn::posterior:
      return "posterior";
    case StoppedIn::cross_validation:
      return "cross_validation";
  }
  return "";
}

}  // namespace rigcal::calib
