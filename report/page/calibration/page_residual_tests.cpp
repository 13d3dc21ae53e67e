#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "report/figure/time_plots.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label) {
  return {title, x_label, y_label, 300.0, 170.0};
}

Plot correlation_plot(const metrics::Correlogram& curve, const std::string& title, bool bars) {
  Trace trace = empty_trace(bars ? Trace::Kind::bars : Trace::Kind::line, "residual");
  double size = 0.0;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const double lag = curve.first_lag_s + curve.lag_step_s * static_cast<double>(i);
    // The autocorrelation at lag 0 is 1 and would compress the rest of the plot.
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

std::vector<Plot> test_plots(const metrics::ResidualCurves& curves,
                             std::string_view channel_unit_name) {
  std::vector<Plot> plots;
  plots.push_back(correlation_plot(curves.autocorrelation, "autocorrelation", true));
  if (curves.cross_correlation) {
    plots.push_back(
        correlation_plot(*curves.cross_correlation, "cross-correlation with input", false));
  }
  const ReadableUnit unit =
      readable_unit(std::sqrt(largest(curves.periodogram.density)), channel_unit_name);
  const std::string name =
      unit.name.find(' ') == std::string::npos ? unit.name : "(" + unit.name + ")";
  Plot power = small_plot(
      "periodogram", "frequency [Hz]",
      name.empty() ? "power density [1/Hz]" : fmt::format("power density [{}²/Hz]", name));
  power.log_x = true;
  power.log_y = true;
  Trace density;
  density.style = "residual";
  density.x = curves.periodogram.frequency_hz;
  density.y = curves.periodogram.density;
  for (double& value : density.y) value /= unit.si * unit.si;
  power.traces = {std::move(density)};
  plots.push_back(std::move(power));
  Plot quantiles = small_plot("quantiles", "normal quantile", "residual quantile [std]");
  Trace line;
  line.style = "reference";
  Trace points = empty_trace(Trace::Kind::points, "residual");
  points.x = curves.normality.normal_quantile;
  points.y = curves.normality.residual_quantile;
  if (!points.x.empty()) line.x = line.y = {points.x.front(), points.x.back()};
  quantiles.traces = {std::move(line), std::move(points)};
  plots.push_back(std::move(quantiles));
  return plots;
}

/// Plots the fraction of the power up to each frequency, between the bounds for white noise.
Plot cumulative_plot(const metrics::CumulativePower& curve) {
  Plot plot = small_plot("cumulative periodogram, with the 95 % bounds of white noise",
                         "frequency [Hz]", "fraction of the power");
  Trace power = empty_trace(Trace::Kind::line, "residual");
  const auto steps = static_cast<double>(std::max<std::size_t>(curve.fraction.size(), 2) - 1);
  for (const double fraction : curve.fraction) {
    power.x.push_back(curve.last_frequency_hz * static_cast<double>(power.x.size()) / steps);
    power.y.push_back(fraction);
  }
  for (const double offset : {-curve.limit, curve.limit}) {
    Trace bound = empty_trace(Trace::Kind::line, "reference");
    bound.x = {0.0, curve.last_frequency_hz};
    bound.y = {offset, 1.0 + offset};
    plot.traces.push_back(std::move(bound));
  }
  plot.traces.push_back(std::move(power));
  return plot;
}

/// Returns the figures that show how a residual differs from white noise, folded. They are not on
/// paper, where the autocorrelation and the periodogram stand for them.
std::optional<doc::Fold> whiteness_fold(const metrics::ResidualCurves& curves) {
  doc::Gallery gallery;
  if (curves.partial_autocorrelation) {
    Plot plot = correlation_plot(*curves.partial_autocorrelation, "partial autocorrelation", true);
    plot.title += ", with the 95 % band of white noise";
    gallery.figures.push_back(
        figure_of(std::move(plot), "Which lags matter beyond the shorter ones?"));
  }
  if (curves.cumulative_periodogram)
    gallery.figures.push_back(figure_of(cumulative_plot(*curves.cumulative_periodogram),
                                        "At which frequencies is there too much power?"));
  if (gallery.figures.empty()) return std::nullopt;
  doc::Fold fold{"Partial autocorrelation and cumulative periodogram", {std::move(gallery)}};
  fold.style = "screen";
  fold.blocks.emplace_back(doc::reading(
      "Dashed: 95 % bounds for white noise, at a single lag and for the whole cumulative curve."));
  return fold;
}

doc::Mark mark_of(metrics::TestOutcome outcome) {
  switch (outcome) {
    case metrics::TestOutcome::passed:
      return {doc::State::good, "passed"};
    case metrics::TestOutcome::failed:
      return {doc::State::warn, "failed"};
    case metrics::TestOutcome::not_judged:
      return {doc::State::none, "cannot be judged"};
  }
  return {};
}

doc::Facts test_facts(const metrics::ResidualTests& tests, const std::string& channel) {
  doc::Facts facts{"Residual tests of " + channel};
  facts.caption = {channel};
  const auto add = [&](const char* name, const auto& test) {
    facts.rows.push_back({name, {mark_of(test.outcome), " " + test.verdict}});
  };
  add("Autocorrelation", tests.autocorrelation);
  if (tests.cross_correlation) add("Cross-correlation with the input", *tests.cross_correlation);
  add("Periodogram", tests.periodogram);
  add("Normality", tests.normality);
  add("Drift", tests.drift);
  return facts;
}

}  // namespace

void add_residual_tests(const calib::ConditionResult& condition, const calib::ChannelCurves* curves,
                        doc::Blocks& blocks) {
  if (condition.channels.empty()) return;
  blocks.emplace_back(doc::Heading{{"Residual tests"}, 4});
  for (const calib::ChannelScore& score : condition.channels) {
    const std::string channel(score.key());
    if (!score.residual_tests) {
      blocks.emplace_back(
          doc::reading(channel + ": not tested (too few samples, or a constant residual)."));
      continue;
    }
    blocks.emplace_back(test_facts(*score.residual_tests, channel));
    const auto* found = curves == nullptr ? nullptr : find(*curves, score.channel);
    if (found == nullptr || !*found) continue;
    doc::Gallery gallery;
    for (Plot& plot : test_plots(**found, info(score.channel).unit))
      gallery.figures.push_back(figure_of(std::move(plot)));
    blocks.emplace_back(std::move(gallery));
    if (auto fold = whiteness_fold(**found)) blocks.emplace_back(std::move(*fold));
  }
}

}  // namespace rigcal::report
