#include "calib/result/aspect.hpp"

#include <algorithm>

namespace rigcal::calib {
namespace {

/// Returns how serious a state is; a higher rank is more serious.
int rank(AspectState state) {
  switch (state) {
    case AspectState::fail:
      return 4;
    case AspectState::not_assessed:
      return 3;
    case AspectState::reservation:
      return 2;
    case AspectState::pass:
      return 1;
    case AspectState::note:
      break;
  }
  return 0;
}

}  // namespace

bool is_against(AspectState state) { return rank(state) > rank(AspectState::pass); }

Reason reason(AspectState state, std::string code, std::string words, const std::string& subject,
              Keyed<double> numbers) {
  return {std::move(code), state, unless_empty(subject), std::move(numbers), std::move(words)};
}

Aspect aspect_of(std::vector<Reason> reasons) {
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Reason& a, const Reason& b) { return rank(a.state) > rank(b.state); });
  Aspect aspect;
  if (!reasons.empty() && reasons.front().state != AspectState::note)
    aspect.state = reasons.front().state;
  aspect.reasons = std::move(reasons);
  return aspect;
}

}  // namespace rigcal::calib
