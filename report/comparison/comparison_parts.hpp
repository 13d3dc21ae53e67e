#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {

// What comparison.json is made of, and what its readers share. Functions of results throw
// nlohmann::json::exception where one is not what this version writes.

inline constexpr double kSignificantLevel = 0.05;

/// Reason of a difference between values that neither result estimates.
inline constexpr const char* kKnownInBoth = "known in both";

/// Converged or stopped: its numbers may be shown.
bool is_usable(const Json& result);
/// A fit to published tables; it has no records.
bool is_of_tables(const Json& result);
/// The larger of standard and robust error.
std::optional<double> error_of(const Json& parameter);
/// The condition of this name; null where the result has none.
const Json* find_condition(const Json& result, const std::string& id);

/// Files by hash of what a result was made from, but for the campaign file and an earlier fit.
std::map<std::string, std::string> record_hashes(const Json& result);
/// Whether two results rest on the same records or published numbers, at least in part.
bool share_records(const Json& a, const Json& b);

/// `parameters` of comparison.json: estimates side by side, differences from the first.
Json compared_parameters(const std::vector<Compared>& results);
/// `significance`: per result, null for the first, how many parameters that one of the two
/// estimates were compared with the first, how many of these tested, and why the others were not,
/// in words.
///
/// @param parameters  as compared_parameters() gives them, of `results` results
Json tested_parameters(const Json& parameters, std::size_t results);

/// A difference from the first result that a reader must see: significant, or not tested.
struct Change {
  std::string parameter, result;
  std::string by;           ///< "+1.2 %", or "+0.3 mm" where the first value may be zero
  std::optional<double> p;  ///< for all parameters together; absent where it was not tested
  std::string reason;       ///< why not
};
/// The significant ones first, the surest before the others; then the others, the largest in
/// standard errors first.
///
/// @param comparison  with `results` and `parameters`
std::vector<Change> changes_of(const Json& comparison);

/// `conditions`: scores side by side.
Json compared_conditions(const std::vector<Compared>& results);
/// `metrics`: means over the conditions that the first and another result have; a sign test where
/// the records are not shared and enough conditions differ.
///
/// @param conditions  as compared_conditions() gives them, of `results`
Json compared_metrics(const Json& conditions, const std::vector<Compared>& results);
/// `records`: which file went into which result.
Json compared_records(const std::vector<Compared>& results);
/// Estimates of the parameter of a key along dates and temperatures: a list of {`of`, `points`,
/// `along_date`, `along_temperature`}.
Json trends(const std::vector<Compared>& results, std::string_view key);
/// `leak_trends`: leakage coefficients along dates and temperatures.
Json leak_trends(const std::vector<Compared>& results);

/// A difference from the first result in percent; where that value is zero or not significantly
/// different from it, in the unit. Empty where one has no value.
std::string change_text(const Json& difference, const RowUnit& unit);
/// Whether a parameter of comparison.json tells anything: some result estimates it, or known
/// values differ.
bool worth_a_row(const Json& parameter);
/// The unit in which the largest estimate of a parameter of comparison.json has few digits.
RowUnit unit_of_estimates(const Json& parameter);

}  // namespace rigcal::report
