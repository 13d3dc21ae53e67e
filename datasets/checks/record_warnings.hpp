#pragma once

#include <string>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// A warning, and the conditions to which it applies.
struct RecordWarning {
  std::string text;
  std::vector<std::string> conditions;  ///< in the order of the records; at least one

  /// Returns, for example, "recording of sine: ..." or "recordings of 24 conditions (sine, ...):
  /// ...".
  std::string with_conditions() const;
};

/// Collects the warnings of all records, each text once, in the order of first appearance.
std::vector<RecordWarning> gathered_warnings(const std::vector<const Record*>& records);

}  // namespace rigcal::datasets
