#include "report/page/calibration/score_columns.hpp"

#include <cmath>
#include <utility>

#include "metrics/metric_table.hpp"
#include "report/document/quantity.hpp"

namespace rigcal::report {
namespace {

constexpr int kDigits = 4;

doc::Quantity score_of(const metrics::MetricSpec& metric, double value, std::string_view unit) {
  if (metric.unit == "channel") return doc::readable(value, unit, kDigits);
  // If the best value of a score is 1, the score has enough digits to show its distance from 1.
  if (metric.unit == "1" && metric.highest == 1.0) return doc::agreement(value);
  // If the best value of a score is 100 %, the score has one more digit.
  return doc::in_unit(value, 1.0, metric.higher_is_better ? kDigits + 1 : kDigits);
}

}  // namespace

std::vector<doc::Column> score_columns() {
  std::vector<doc::Column> columns;
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    columns.push_back({std::string(metric.title), doc::Column::Kind::number});
  return columns;
}

std::vector<doc::Cell> score_cells(const metrics::Agreement& scores,
                                   const metrics::Agreement* uncertainty, std::string_view unit) {
  std::vector<doc::Cell> cells;
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    doc::Cell& cell = cells.emplace_back();
    cell.line = {score_of(metric, scores.*metric.value, unit)};
    if (uncertainty == nullptr) continue;
    const double half = uncertainty->*metric.value;
    doc::Quantity printed = doc::readable(half, unit, kErrorDigits);
    if (metric.unit != "channel")
      printed = {doc::Number(half).value,
                 std::isnan(half) ? "–" : uncertainty_text(half, scores.*metric.value)};
    cell.below = {{"± ", std::move(printed)}};
  }
  return cells;
}

}  // namespace rigcal::report
