#include "calib/result/condition_score.hpp"

#include <algorithm>

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

std::optional<Verdict> ConditionScore::verdict_of(datasets::Channel of) const {
  if (!failure.empty()) return verdict;
  std::optional<Verdict> worst;
  for (const LimitCheck& check : checks) {
    if (check.channel == of) worst = std::max(worst.value_or(check.verdict), check.verdict);
  }
  return worst;
}

}  // namespace rigcal::calib
