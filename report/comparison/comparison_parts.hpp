#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/text/estimate_text.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {

// The sections of a comparison, and the functions that they share.

/// Whether the numbers of a result may be shown: the fit converged or was stopped.
inline bool is_usable(const StoredFit& fit) { return fit.status != calib::FitStatus::failed; }

/// Returns the input files of a result by hash, without the campaign file and any earlier fit.
std::map<std::string, std::string> record_hashes(const StoredFit& fit);
/// Returns true if two results used at least one common file or published table, for fitting or for
/// scoring.
bool share_records(const Compared& a, const Compared& b);
/// Returns true if the estimates of two results are based on common data: a published table, or
/// samples of the same file (by SHA-256) in overlapping windows. Files from earlier versions do not
/// name the fitted records, so all their inputs count as fitted.
bool share_fitted_records(const Compared& a, const Compared& b);

/// Lists the estimates side by side, with their differences from the first result.
std::vector<StoredComparedParameter> compared_parameters(const std::vector<Compared>& results);
/// Counts, for each result, the parameters that were compared with the first result and those that
/// were tested. A parameter is compared if at least one of the two results estimates it. The text
/// explains why the other parameters were not tested. The entry for the first result is
/// std::nullopt.
///
/// @param parameters  from compared_parameters(), for `results` results
std::vector<std::optional<StoredSignificance>> tested_parameters(
    const std::vector<StoredComparedParameter>& parameters, std::size_t results);

/// A difference from the first result that the reader must see: it is significant, or it could not
/// be tested.
struct Change {
  std::string parameter, result;
  std::string by;           ///< "+1.2 %", or "+0.3 mm" if the first value may be zero
  std::optional<double> p;  ///< adjusted for all parameters; absent if not tested
  std::string reason;       ///< why the difference was not tested
};
/// Returns the significant changes first, in order of increasing p-value. Untested changes follow,
/// largest in standard errors first.
std::vector<Change> changes_of(const StoredComparison& comparison);

/// Lists the scores side by side.
std::vector<StoredComparedCondition> compared_conditions(const std::vector<Compared>& results);
/// Computes mean scores over the conditions that the first result and another one have in common.
/// Adds a sign test if the two have no common records and enough conditions differ.
///
/// @param conditions  from compared_conditions(), for `results`
std::vector<StoredComparedMetric> compared_metrics(
    const std::vector<StoredComparedCondition>& conditions, const std::vector<Compared>& results);
/// Compares the models of the other results with that of the first. The entry for the first result
/// is std::nullopt. Every other entry has the information criteria relative to the first. The
/// likelihood-ratio test is added if the models are nested: all free parameters of one fit are also
/// free in the other, and everything else is equal. `reason` explains a missing number, such as
/// different records or weights, or a fit that did not converge.
///
/// @throws InputError  if a result contains impossible counts
std::vector<std::optional<StoredModelChoice>> compared_models(const std::vector<Compared>& results);
/// Lists the input files and the results that used them.
std::vector<StoredComparedRecord> compared_records(const std::vector<Compared>& results);
/// Collects the estimates of one parameter over dates and temperatures.
///
/// @param key  key of the parameter
std::vector<StoredSeries> trends(const std::vector<Compared>& results, std::string_view key);
/// Returns the points of a series that have an error and a position. A trend is fitted to them.
std::vector<calib::PlacedEstimate> placed_estimates(const std::vector<StoredTrendPoint>& points,
                                                    std::optional<double> StoredTrendPoint::*place);

/// Writes a difference from the first result in percent, or in `unit` if the first value is zero or
/// not significantly different from zero. Returns an empty text if either value is missing.
std::string change_text(const calib::EstimateDifference& difference, const ReadableUnit& unit);
/// Whether a table should list a parameter: a result estimates it, or its known values differ.
bool worth_a_row(const StoredComparedParameter& parameter);
/// Chooses the unit in which the largest estimate of a parameter needs few digits.
ReadableUnit unit_of_estimates(const StoredComparedParameter& parameter);
inline std::string parameter_label(const StoredComparedParameter& p) {
  return parameter_label(p.key, p.scope, p.level);
}

}  // namespace rigcal::report
