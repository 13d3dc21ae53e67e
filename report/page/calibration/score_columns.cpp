#include "report/page/calibration/score_columns.hpp"

#include "metrics/metric_table.hpp"

namespace rigcal::report {
namespace {

constexpr int kDigits = 4;
constexpr int kDigitsOfUncertainty = 2;

Json score_cell(const metrics::MetricSpec& metric, double value, std::string_view unit) {
  if (metric.unit == "channel") return shown(value, unit, kDigits);
  // One that can reach 1 is told by what it lacks of it.
  if (metric.unit == "1" && metric.highest == 1.0) return shown_agreement(value);
  // So is one that can reach 100 %, by a digit more.
  return shown_in(value, 1.0, metric.higher_is_better ? kDigits + 1 : kDigits);
}

}  // namespace

Json score_titles() {
  Json titles = Json::array();
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    titles.push_back({{"title", metric.title}});
  return titles;
}

Json score_cells(const metrics::Agreement& scores, const metrics::Agreement* uncertainty,
                 std::string_view unit) {
  Json cells = Json::array();
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    Json& cell = cells.emplace_back(score_cell(metric, scores.*metric.value, unit));
    if (uncertainty == nullptr) continue;
    const double half = uncertainty->*metric.value;
    cell["uncertain"] = {{"half", metric.unit == "channel"
                                      ? shown(half, unit, kDigitsOfUncertainty)
                                      : shown_in(half, 1.0, kDigitsOfUncertainty)}};
  }
  return cells;
}

}  // namespace rigcal::report
