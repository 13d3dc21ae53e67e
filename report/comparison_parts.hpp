#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/comparison.hpp"
#include "report/page_parts.hpp"

namespace rigcal::report {

// What comparison.json is made of, and what its readers share. Functions of results throw
// nlohmann::json::exception where one is not what this version writes.

inline constexpr double kSignificantLevel = 0.05;

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
/// `conditions`: scores side by side.
Json compared_conditions(const std::vector<Compared>& results);
/// `metrics`: means over the conditions that the first and another result have, sign tests.
///
/// @param conditions  as compared_conditions() gives them, of `count` results
Json compared_metrics(const Json& conditions, std::size_t count);
/// `records`: which file went into which result.
Json compared_records(const std::vector<Compared>& results);
/// `leak_trends`: leakage coefficients along dates and temperatures.
Json leak_trends(const std::vector<Compared>& results);

/// Whether a parameter of comparison.json tells anything: some result estimates it, or known
/// values differ.
bool worth_a_row(const Json& parameter);
/// The unit in which the largest estimate of a parameter of comparison.json has few digits.
RowUnit unit_of_estimates(const Json& parameter);

}  // namespace rigcal::report
