#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/campaign/diagnosis_settings.hpp"

namespace rigcal::diagnosis {

/// A classified record whose true class is known.
struct Judged {
  std::string condition;
  datasets::LeakClass truth = datasets::LeakClass::normal;
  std::optional<datasets::LeakClass> found;  ///< empty: undecided
};

/// Accuracy of a classification method.
struct Accuracy {
  /// Counts. The row is the true class, the column the class found; the last column is undecided.
  std::array<std::array<int, datasets::kLeakClasses.size() + 1>, datasets::kLeakClasses.size()>
      confusion{};
  int records = 0;
  int right = 0;
  int off_by_two = 0;  ///< wrong by two classes or more
  int undecided = 0;   ///< counted as wrong
  int conditions = 0;
  double accuracy = 0.0;  ///< right / records
  /// Wilson's 95 % interval, with as many independent trials as there are conditions, because
  /// repeats of one condition have errors in common.
  std::pair<double, double> ci95{0.0, 1.0};
};

/// @param judged  may be empty; everything is then zero and the interval is meaningless
Accuracy accuracy_of(const std::vector<Judged>& judged);

/// Wilson's 95 % score interval for a proportion. E. B. Wilson, J. Am. Stat. Assoc. 22 (1927).
///
/// @param proportion  in [0, 1]
/// @param trials      > 0
std::pair<double, double> wilson_interval(double proportion, double trials);

}  // namespace rigcal::diagnosis
