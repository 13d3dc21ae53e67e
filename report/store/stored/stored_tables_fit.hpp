#pragma once

#include <optional>
#include <string>

#include "diagnosis/table/fit_tables.hpp"
#include "report/store/stored/stored_fit.hpp"

// fit.json from a fit to published tables, which has no records.

namespace rigcal::report {

inline constexpr const char* kOfTables = "published tables";

struct StoredTablesFit : diagnosis::TablesFit {
  std::string schema = kFitSchema;
  std::optional<calib::Verdict> verdict;
  std::string campaign;
  std::string of = kOfTables;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, verdict, message, campaign, of, cost, residual_count, rms,
                  evaluations, iterations, wall_seconds, parameters, correlation, residuals,
                  left_out, provenance)
};

/// Whether a fit.json comes from a fit to published tables.
inline bool is_of_tables(const Json& fit) { return fit.is_object() && fit.contains("of"); }

/// Converts a fit to tables to a fit to records, with the members that both have.
StoredFit as_fit(const StoredTablesFit& tables);

}  // namespace rigcal::report
