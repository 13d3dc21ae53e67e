#include "calib/result/uncertainty_budget.hpp"

#include <cmath>

namespace rigcal::calib {

double Budget95::contribution(std::string_view of_kind) const {
  double squares = 0.0;
  for (const BudgetLine& line : lines)
    if (line.kind == of_kind) squares += line.uncertainty * line.uncertainty;
  return std::sqrt(squares);
}

std::optional<double> Budget95::beside_of(std::string_view kind) const {
  if (!beside) return std::nullopt;
  for (const BudgetLine& line : *beside)
    if (line.kind == kind) return line.uncertainty;
  return std::nullopt;
}

const BudgetLine* Budget95::largest_effect() const {
  const BudgetLine* largest = nullptr;
  for (const BudgetLine& line : lines) {
    const bool counts = line.kind == "effect" && line.uncertainty > 0.0;
    if (counts && (largest == nullptr || line.uncertainty > largest->uncertainty)) largest = &line;
  }
  return largest;
}

}  // namespace rigcal::calib
