#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"

namespace rigcal::diagnosis {

/// A classified record whose true class is known.
struct Judged {
  std::string condition;
  datasets::LeakClass truth = datasets::LeakClass::normal;
  std::optional<datasets::LeakClass> found;  ///< assigned class; absent if undecided
};

/// Confusion matrix of record counts. Rows are true classes, columns are assigned classes.
struct Confusion {
  static constexpr std::size_t kClasses = datasets::kLeakClasses.size();
  std::array<std::string, kClasses> truth;      ///< names of the rows
  std::array<std::string, kClasses + 1> found;  ///< names of the columns; the last is "undecided"
  std::array<std::array<int, kClasses + 1>, kClasses> counts{};
  RIGCAL_DESCRIBE(truth, found, counts)

  Confusion();
};

/// Accuracy of a method of classification.
struct Accuracy {
  int records = 0;
  int conditions = 0;
  int right = 0;
  int undecided = 0;               ///< undecided records, which count as wrong
  int off_by_two_or_more = 0;      ///< number of records whose class is wrong by at least two
  std::optional<double> accuracy;  ///< right / number of records
  /// Wilson's 95 % interval. The number of conditions is used as the number of independent trials,
  /// because the repeats of one condition share errors.
  std::optional<Range> accuracy_ci95;
  Confusion confusion;
  RIGCAL_DESCRIBE(records, conditions, right, undecided, off_by_two_or_more, accuracy,
                  accuracy_ci95, confusion)
};

/// Accuracy of each method.
struct Methods {
  Accuracy fitted_leak_single;             ///< fitted leaks in single repeats
  Accuracy fitted_leak_averaged;           ///< fitted leaks in averages
  Accuracy features_leave_one_repeat_out;  ///< the paper's features, learned without the repeat
  Accuracy features_leave_one_signal_out;
  RIGCAL_DESCRIBE(fitted_leak_single, fitted_leak_averaged, features_leave_one_repeat_out,
                  features_leave_one_signal_out)
};

/// Computes the accuracy of a method.
///
/// @param judged  classified records; if empty, the accuracy is absent
Accuracy accuracy_of(const std::vector<Judged>& judged);

/// Returns Wilson's 95 % score interval for a proportion (E. B. Wilson, J. Am. Stat. Assoc. 22,
/// 1927).
///
/// @param proportion  in [0, 1]
/// @param trials      > 0
Range wilson_interval(double proportion, double trials);

}  // namespace rigcal::diagnosis
