#pragma once

#include <string>
#include <vector>

#include "calib/result/uncertainty_budget.hpp"
#include "report/document/document.hpp"
#include "report/page/page_parts.hpp"

// Uncertainty budgets as tables, the same for estimates, scores and shares.

namespace rigcal::report {

/// Number of significant digits of a contribution.
inline constexpr int kBudgetDigits = 3;

/// An uncertainty budget and the result that it belongs to.
struct BudgetOf {
  std::string name;  ///< name of the result
  ReadableUnit unit;
  const calib::Budget95* budget;
};

/// Returns a table with one row per budget. The contributions are combined by kind; their squares
/// add up to that of u. Columns that no budget needs are left out: days, shift, and the two for
/// Budget95::beside.
///
/// @param what  title of the column of names
doc::Table budget_table(const std::string& what, const std::vector<BudgetOf>& budgets);

/// Returns a table of all contributions one by one, folded. Negligible contributions to the same
/// result are combined in one row.
doc::Fold contributions(const std::string& what, const std::vector<BudgetOf>& budgets);

}  // namespace rigcal::report
