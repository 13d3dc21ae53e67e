#include "calib/result/condition_score.hpp"

namespace rigcal::calib {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "PASS";
    case Verdict::warn:
      return "WARN";
    case Verdict::fail:
      return "FAIL";
  }
  return "";
}

}  // namespace rigcal::calib
