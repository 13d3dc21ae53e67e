#include "report/page/budget_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/document/quantity.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

std::string freedom_text(double freedom) {
  constexpr double kMany = 1000.0;
  return freedom > kMany ? std::string("many") : fmt::format("{:.0f}", freedom);
}

/// Columns that only some results have.
struct FurtherColumns {
  bool days = false;
  bool shift = false;
  bool beside = false;
};

FurtherColumns further_columns(const std::vector<BudgetOf>& budgets) {
  FurtherColumns columns;
  for (const BudgetOf& each : budgets) {
    columns.days = columns.days || each.budget->contribution("days") > 0.0;
    columns.shift = columns.shift || each.budget->shift != 0.0;
    columns.beside = columns.beside || each.budget->beside;
  }
  return columns;
}

doc::Row budget_row(const BudgetOf& of, const FurtherColumns& further) {
  const calib::Budget95& budget = *of.budget;
  const auto number = [&](double value) { return doc::in_unit(value, of.unit.si, kBudgetDigits); };
  const calib::BudgetLine* largest = budget.largest_effect();
  doc::Row row{{of.name, of.unit.name, number(budget.contribution("records")),
                number(budget.contribution("known_value")), number(budget.contribution("effect"))}};
  if (further.days) row.cells.push_back(number(budget.contribution("days")));
  for (doc::Cell cell :
       {doc::Cell(number(budget.combined)), doc::Cell(freedom_text(budget.degrees_of_freedom)),
        doc::Cell(doc::decimals(budget.coverage_factor, 2)), doc::Cell(number(budget.expanded))})
    row.cells.push_back(std::move(cell));
  if (further.shift) row.cells.push_back(number(budget.shift));
  if (further.beside) {
    for (const char* kind : {"days", "numerics"})
      row.cells.push_back(doc::in_unit(budget.beside_of(kind), of.unit.si, kBudgetDigits));
  }
  row.cells.push_back(largest == nullptr ? std::string("–") : spaced(largest->source));
  return row;
}

void add_lines(const BudgetOf& of, std::vector<doc::Row>& rows) {
  constexpr double kHardly = 1e-3;  // as a fraction of the variance
  const calib::Budget95& budget = *of.budget;
  const double whole = budget.combined * budget.combined;
  double others = 0.0;
  const auto add = [&](const std::string& source, double squares) {
    rows.push_back({{of.name, source, doc::in_unit(std::sqrt(squares), of.unit.si, kBudgetDigits),
                     of.unit.name, doc::decimals(whole > 0.0 ? 100.0 * squares / whole : 0.0, 1)}});
  };
  for (const calib::BudgetLine& line : budget.lines) {
    const double square = line.uncertainty * line.uncertainty;
    if (line.kind == "records" || square >= kHardly * whole) {
      add(spaced(line.source), square);
    } else {
      others += square;
    }
  }
  if (others > 0.0) add("all others", others);
}

}  // namespace

doc::Table budget_table(const std::string& what, const std::vector<BudgetOf>& budgets) {
  doc::Table table{"Uncertainty budget"};
  table.style = "budget";
  table.caption = {"Uncertainty budget: standard uncertainties u; their squares add up"};
  const FurtherColumns further = further_columns(budgets);
  table.columns = {{what},
                   {"Unit"},
                   {"Records", Kind::number},
                   {"Known values", Kind::number},
                   {"Effects left out", Kind::number}};
  if (further.days) table.columns.push_back({"Days", Kind::number});
  for (const char* title : {"u", "Degrees of freedom", "k", "U = k u"})
    table.columns.push_back({title, Kind::number});
  if (further.shift) table.columns.push_back({"Shift", Kind::number});
  if (further.beside) {
    table.columns.push_back({"Beside it: days", Kind::number});
    table.columns.push_back({"In addition: numerical error, at most", Kind::number});
  }
  table.columns.push_back({"Largest effect"});
  for (const BudgetOf& each : budgets) table.rows.push_back(budget_row(each, further));
  return table;
}

doc::Fold contributions(const std::string& what, const std::vector<BudgetOf>& budgets) {
  doc::Table lines{"Contributions one by one"};
  lines.style = "dense";
  lines.columns = {{what},
                   {"Source"},
                   {"u", Kind::number},
                   {"Unit", Kind::unit},
                   {"Fraction of the variance, %", Kind::number}};
  for (const BudgetOf& each : budgets) add_lines(each, lines.rows);
  std::string summary = fmt::format("Contributions one by one ({})", lines.rows.size());
  return {std::move(summary), {std::move(lines)}};
}

}  // namespace rigcal::report
