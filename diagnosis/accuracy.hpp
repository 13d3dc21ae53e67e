#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/range.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"

namespace rigcal::diagnosis {

/// One classified record whose class is known.
struct Judged {
  std::string condition;
  datasets::LeakClass truth = datasets::LeakClass::normal;
  std::optional<datasets::LeakClass> found;  ///< empty: undecided
};

/// Accuracy of a method.
struct Accuracy {
  /// Counts: row of the truth, column of the class found, the last one undecided.
  std::array<std::array<int, datasets::kLeakClasses.size() + 1>, datasets::kLeakClasses.size()>
      confusion{};
  int records = 0;
  int right = 0;
  int off_by_two = 0;  ///< wrong by two classes or more
  int undecided = 0;   ///< counted as wrong
  int conditions = 0;
  double accuracy = 0.0;  ///< right / records
  /// Wilson's 95 % interval for as many independent trials as there are conditions: repeats of one
  /// condition have common errors.
  Range ci95{0.0, 1.0};
};

/// @param judged  may be empty; then everything is zero and the interval means nothing
Accuracy accuracy_of(const std::vector<Judged>& judged);

/// Wilson's score interval of a proportion at 95 %. E. B. Wilson, J. Am. Stat. Assoc. 22 (1927).
///
/// @param proportion  in [0, 1]
/// @param trials      > 0
Range wilson_interval(double proportion, double trials);

}  // namespace rigcal::diagnosis
