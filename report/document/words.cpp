#include "report/document/words.hpp"

namespace rigcal::report::doc {

Badge badge(calib::Verdict verdict) {
  switch (verdict) {
    case calib::Verdict::pass:
      return {State::good, "PASS"};
    case calib::Verdict::warn:
      return {State::warn, "WARN"};
    case calib::Verdict::fail:
      return {State::bad, "FAIL"};
  }
  return {};
}

Badge badge(const std::optional<calib::Verdict>& verdict) {
  return verdict ? badge(*verdict) : Badge{State::none, "not judged"};
}

Badge badge(calib::AspectState state) {
  switch (state) {
    case calib::AspectState::pass:
      return {State::good, "pass"};
    case calib::AspectState::reservation:
      return {State::warn, "reservation"};
    case calib::AspectState::fail:
      return {State::bad, "fail"};
    case calib::AspectState::not_assessed:
      return {State::none, "not assessed"};
    case calib::AspectState::note:
      return {State::none, "note"};
  }
  return {};
}

Badge badge(calib::Identifiability grade) {
  switch (grade) {
    case calib::Identifiability::identified:
      return {State::good, "identified"};
    case calib::Identifiability::weak:
      return {State::warn, "weak"};
    case calib::Identifiability::bounded:
      return {State::warn, "bounded: consistent with zero"};
    case calib::Identifiability::not_identifiable:
      return {State::bad, "not identifiable"};
  }
  return {};
}

Badge badge(diagnosis::LeakGrade grade) {
  switch (grade) {
    case diagnosis::LeakGrade::within_10:
      return {State::good, "within 10 %"};
    case diagnosis::LeakGrade::within_16:
      return {State::warn, "within 16 %"};
    case diagnosis::LeakGrade::outlier:
      return {State::bad, "outlier"};
    case diagnosis::LeakGrade::not_published:
      return {State::none, "not published"};
  }
  return {};
}

Badge badge(datasets::LeakClass leak_class) {
  const std::string words(to_string(leak_class));
  switch (leak_class) {
    case datasets::LeakClass::normal:
      return {State::good, words};
    case datasets::LeakClass::slight:
    case datasets::LeakClass::medium:
      return {State::warn, words};
    case datasets::LeakClass::critical:
    case datasets::LeakClass::supercritical:
      return {State::bad, words};
  }
  return {};
}

Badge badge(const std::optional<calib::Identifiability>& grade, bool at_bound, bool judged) {
  if (!judged) return {State::none, "not judged"};
  if (!grade) return {State::good, ""};
  Badge found = badge(*grade);
  if (!at_bound || grade == calib::Identifiability::bounded) return found;
  found.words += ", at a bound";
  if (found.state == State::good) found.state = State::warn;
  return found;
}

}  // namespace rigcal::report::doc
