#include "report/page/budget_tables.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace rigcal::report {
namespace {

std::vector<std::string> titles(const doc::Table& table) {
  std::vector<std::string> result;
  for (const doc::Column& column : table.columns) result.push_back(column.title);
  return result;
}

bool has(const doc::Table& table, const std::string& title) {
  const auto all = titles(table);
  return std::find(all.begin(), all.end(), title) != all.end();
}

}  // namespace

TEST_CASE("budget_table: columns of days and shifts only where a budget has them", "[report]") {
  calib::Budget95 budget;
  budget.lines = {{"noise", "records", 3.0}, {"ki", "effect", 4.0}};
  budget.combined = 5.0;
  const doc::Table plain = budget_table("Share of", {{"sine", {"%", 1.0}, &budget}});
  CHECK_FALSE(has(plain, "Days"));
  CHECK_FALSE(has(plain, "Shift"));
  CHECK_FALSE(has(plain, "In addition: numerical error, at most"));
  calib::Budget95 of_another_day = budget;
  of_another_day.lines.push_back({"days", "days", 12.0});
  of_another_day.combined = 13.0;
  of_another_day.shift = 1.0;
  of_another_day.beside = std::vector<calib::BudgetLine>{{"numerics", "numerics", 0.01}};
  const doc::Table both = budget_table(
      "Share of", {{"sine", {"%", 1.0}, &budget}, {"square", {"%", 1.0}, &of_another_day}});
  CHECK(has(both, "Days"));
  CHECK(has(both, "Shift"));
  CHECK(has(both, "In addition: numerical error, at most"));
  for (const doc::Table& table : {plain, both})
    for (const doc::Row& row : table.rows) CHECK(row.cells.size() == table.columns.size());
}

}  // namespace rigcal::report
