#pragma once

#include <string>

#include "calib/published/fit_tables.hpp"
#include "report/store/stored/stored_tables_fit.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

/// Estimated assumptions with all that their files are made from. Borrows everything.
struct TablesFitResult {
  const datasets::Campaign& campaign;
  const calib::TablesFit& fit;
  const Provenance& provenance;
};

/// fit.json of `fit-tables`, with the keys of a fit as far as they apply.
StoredTablesFit stored(const TablesFitResult& result);

/// Estimated values with intervals, omitted numbers, and the status.
std::string tables_fit_text(const TablesFitResult& result, const Style& style);

}  // namespace rigcal::report
