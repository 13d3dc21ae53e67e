#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"

// The contributions to the uncertainty of an estimate, a score or the share of a leak.

namespace rigcal::calib {

/// One contribution to the uncertainty of a result.
struct BudgetLine {
  /// "noise", "repeats", the key of a known value or an effect and the like, see
  /// docs/uncertainty.md.
  std::string source;
  std::string kind;                    ///< "records", "known_value", "effect", "days" or "numerics"
  double uncertainty = 0.0;            ///< contribution to the standard uncertainty of the result
  Omittable<double> sensitivity = {};  ///< change in an estimate per unit of an effect's size, SI
  RIGCAL_DESCRIBE(source, kind, uncertainty, sensitivity)
};

/// Uncertainty budget of a result (JCGM 100:2008, 5.1 and annex G), in the unit of the result. The
/// squared contributions add up to the square of the combined standard uncertainty.
struct Budget95 {
  std::vector<BudgetLine> lines;    ///< the contributions; their squares add up
  double combined = 0.0;            ///< standard uncertainty
  double degrees_of_freedom = 0.0;  ///< effective degrees of freedom of `combined`
  double coverage_factor = 0.0;     ///< k, for 95 %
  double expanded = 0.0;            ///< `coverage_factor` times `combined`
  /// Offset of the interval's centre from an estimate due to the effects. The estimate itself is
  /// not corrected for them.
  double shift = 0.0;
  /// Contributions that are not in `combined`. For an estimate these are "days", because an
  /// interval applies to the days of the records, and "numerics", an upper limit for the errors of
  /// the simulations, which are small by choice of their tolerance.
  Omittable<std::vector<BudgetLine>> beside = {};
  RIGCAL_DESCRIBE(lines, combined, degrees_of_freedom, coverage_factor, expanded, shift, beside)

  /// Uncertainty of one kind in `beside`; absent if there is none.
  std::optional<double> beside_of(std::string_view kind) const;

  /// Combined contribution of all lines of one kind: the root of the sum of their squares.
  double contribution(std::string_view of_kind) const;
  /// The line of the effect with the largest contribution; null if no effect contributes.
  const BudgetLine* largest_effect() const;
};

}  // namespace rigcal::calib
