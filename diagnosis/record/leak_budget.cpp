#include "diagnosis/record/leak_budget.hpp"

#include <cmath>

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

void add_lines(const std::vector<calib::BudgetLine>& lines, double scale, calib::Budget95& budget) {
  for (const calib::BudgetLine& line : lines)
    budget.lines.push_back({line.source, line.kind, std::abs(scale) * line.uncertainty});
}

/// Completes a budget whose lines and combined uncertainty are known.
void complete(double freedom, calib::Budget95& budget) {
  budget.degrees_of_freedom = freedom;
  budget.coverage_factor = metrics::student_t_quantile(0.975, freedom);
  budget.expanded = budget.coverage_factor * budget.combined;
}

}  // namespace

calib::Budget95 coefficient_budget(const CoefficientError& error,
                                   const std::vector<calib::BudgetLine>& of_rig) {
  calib::Budget95 budget;
  add_lines(error.own, 1.0, budget);
  add_lines(of_rig, 1.0, budget);
  if (error.days_se > 0.0) budget.lines.push_back({"days", "days", error.days_se});
  budget.combined = error.total();
  complete(error.freedom, budget);
  return budget;
}

calib::Budget95 share_budget(const CoefficientError& error, double share_slope,
                             const std::vector<calib::BudgetLine>& of_rig, double days_se) {
  constexpr double kPercent = 100.0;
  calib::Budget95 budget;
  add_lines(error.own, kPercent * share_slope, budget);
  add_lines(of_rig, kPercent, budget);
  if (days_se > 0.0) budget.lines.push_back({"days", "days", kPercent * days_se});
  double squares = 0.0;
  for (const calib::BudgetLine& line : budget.lines) squares += line.uncertainty * line.uncertainty;
  budget.combined = std::sqrt(squares);
  complete(error.freedom, budget);
  return budget;
}

}  // namespace rigcal::diagnosis
