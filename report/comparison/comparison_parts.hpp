#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {

// Parts of a comparison, and functions that they share.

/// Converged or stopped: its numbers may be shown.
inline bool is_usable(const StoredFit& fit) { return fit.status != calib::FitStatus::failed; }

/// Input files of a result by hash, without the campaign file and an earlier fit.
std::map<std::string, std::string> record_hashes(const StoredFit& fit);
/// Whether two results used at least one common file or published table, for fitting or for
/// scoring.
bool share_records(const Compared& a, const Compared& b);
/// Whether the estimates of two results used common data: a published table, or samples of one file
/// (by SHA-256) within windows of both. Files of earlier versions do not name the fitted records;
/// all inputs of such a file count as fitted.
bool share_fitted_records(const Compared& a, const Compared& b);

/// Estimates side by side, differences from the first.
std::vector<StoredComparedParameter> compared_parameters(const std::vector<Compared>& results);
/// For each result (nothing for the first): how many parameters that one of the two estimates were
/// compared with the first, how many of these were tested, and why the others were not, in words.
///
/// @param parameters  of `results` results, from compared_parameters()
std::vector<std::optional<StoredSignificance>> tested_parameters(
    const std::vector<StoredComparedParameter>& parameters, std::size_t results);

/// A difference from the first result that a reader must see: significant, or not tested.
struct Change {
  std::string parameter, result;
  std::string by;           ///< "+1.2 %", or "+0.3 mm" where the first value may be zero
  std::optional<double> p;  ///< for all parameters together; absent if it was not tested
  std::string reason;       ///< why not
};
/// The significant ones first, the surest before the others; then the others, the largest in
/// standard errors first.
std::vector<Change> changes_of(const StoredComparison& comparison);

/// Scores side by side.
std::vector<StoredComparedCondition> compared_conditions(const std::vector<Compared>& results);
/// Means over the conditions that the first and another result have; a sign test where the records
/// are not shared and enough conditions differ.
///
/// @param conditions  as compared_conditions() gives them, of `results`
std::vector<StoredComparedMetric> compared_metrics(
    const std::vector<StoredComparedCondition>& conditions, const std::vector<Compared>& results);
/// Files and the results that used them.
std::vector<StoredComparedRecord> compared_records(const std::vector<Compared>& results);
/// Estimates of the parameter of a key along dates and temperatures.
std::vector<StoredSeries> trends(const std::vector<Compared>& results, std::string_view key);

/// A difference from the first result in percent; where that value is zero or not significantly
/// different from it, in the unit. Empty where one has no value.
std::string change_text(const calib::EstimateDifference& difference, const RowUnit& unit);
/// Whether a parameter is worth a row: a result estimates it, or known values differ.
bool worth_a_row(const StoredComparedParameter& parameter);
/// The unit in which the largest estimate of a parameter has few digits.
RowUnit unit_of_estimates(const StoredComparedParameter& parameter);
inline std::string parameter_label(const StoredComparedParameter& p) {
  return parameter_label(p.key, p.scope, p.level);
}

}  // namespace rigcal::report
