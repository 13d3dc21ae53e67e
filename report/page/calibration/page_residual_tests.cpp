#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = x_label;
  plot.y_label = y_label;
  plot.width = 300.0;
  plot.height = 170.0;
  return plot;
}

Plot correlation_plot(const StoredCorrelogram& curve, const std::string& title, bool bars) {
  Trace trace;
  trace.kind = bars ? Trace::Kind::bars : Trace::Kind::line;
  trace.style = "residual";
  double size = 0.0;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const double lag = curve.first_lag_s + curve.lag_step_s * static_cast<double>(i);
    // A residual's correlation with itself is 1 and would only flatten what counts.
    if (bars && lag == 0.0) continue;
    trace.x.push_back(lag);
    trace.y.push_back(curve.values[i]);
    size = std::max(size, std::abs(lag));
  }
  const ReadableUnit unit = readable_unit(size, "s");
  for (double& x : trace.x) x /= unit.si;
  Plot plot = small_plot(title, fmt::format("lag [{}]", unit.name), title);
  plot.traces = {std::move(trace)};
  plot.levels = {-curve.band, curve.band};
  return plot;
}

std::vector<Plot> test_plots(const StoredResidualCurves& curves,
                             std::string_view channel_unit_name) {
  std::vector<Plot> plots;
  plots.push_back(correlation_plot(curves.autocorrelation, "autocorrelation", true));
  if (curves.cross_correlation) {
    plots.push_back(
        correlation_plot(*curves.cross_correlation, "cross-correlation with input", false));
  }
  Plot power = small_plot("periodogram", "frequency [Hz]",
                          fmt::format("power density [{}^2/Hz]", channel_unit_name));
  power.log_x = true;
  power.log_y = true;
  Trace density;
  density.style = "residual";
  density.x = curves.periodogram.frequency_hz;
  density.y = curves.periodogram.density;
  power.traces = {std::move(density)};
  plots.push_back(std::move(power));
  Plot quantiles = small_plot("quantiles", "normal quantile", "residual quantile [std]");
  Trace line;
  line.style = "reference";
  Trace points;
  points.kind = Trace::Kind::points;
  points.style = "residual";
  points.x = curves.normality.normal_quantile;
  points.y = curves.normality.residual_quantile;
  if (!points.x.empty()) line.x = line.y = {points.x.front(), points.x.back()};
  quantiles.traces = {std::move(line), std::move(points)};
  plots.push_back(std::move(quantiles));
  return plots;
}

struct TestMark {
  const char* mark;
  const char* style;
  const char* word;  ///< for who does not see the mark
};

TestMark mark_of(metrics::TestOutcome outcome) {
  switch (outcome) {
    case metrics::TestOutcome::passed:
      return {"✓", "good", "passed"};
    case metrics::TestOutcome::failed:
      return {"!", "warn", "failed"};
    case metrics::TestOutcome::not_judged:
      break;
  }
  return {"○", "none", "cannot be judged"};
}

Json test_rows(const StoredResidualTests& tests) {
  Json rows = Json::array();
  const auto add = [&](const char* name, const StoredTest& test) {
    const TestMark mark = mark_of(test.outcome);
    rows.push_back({{"name", name},
                    {"mark", mark.mark},
                    {"class", mark.style},
                    {"word", mark.word},
                    {"verdict", test.verdict}});
  };
  add("Autocorrelation", tests.autocorrelation);
  if (tests.cross_correlation) add("Cross-correlation with the input", *tests.cross_correlation);
  add("Periodogram", tests.periodogram);
  add("Normality", tests.normality);
  add("Drift", tests.drift);
  return rows;
}

}  // namespace

Json tests_view(const StoredCondition& condition, const StoredChannelCurves* curves) {
  Json list = Json::array();
  for (const auto& [channel, tests] : condition.residual_tests) {
    Json view{{"channel", channel},
              {"rows", tests ? test_rows(*tests) : Json::array()},
              {"plots", Json::array()},
              {"known", tests.has_value()}};
    const auto* found = curves == nullptr ? nullptr : find(*curves, channel);
    if (tests && found != nullptr && *found) {
      for (const Plot& plot : test_plots(**found, channel_unit(channel)))
        view["plots"].push_back({{"svg_html", svg(plot)}});
    }
    list.push_back(std::move(view));
  }
  return list;
}

}  // namespace rigcal::report
