#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

std::vector<double> numbers_of(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list) {
    values.push_back(value.is_number() ? value.get<double>()
                                       : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

Plot small_plot(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = x_label;
  plot.y_label = y_label;
  plot.width = 300.0;
  plot.height = 170.0;
  return plot;
}

Plot correlation_plot(const Json& curve, const std::string& title, bool bars) {
  const double step = curve.at("lag_step_s").get<double>();
  const double first = curve.at("first_lag_s").get<double>();
  Trace trace;
  trace.kind = bars ? Trace::Kind::bars : Trace::Kind::line;
  trace.style = "residual";
  const std::vector<double> values = numbers_of(curve.at("values"));
  double size = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double lag = first + step * static_cast<double>(i);
    // A residual's correlation with itself is 1 and would only flatten what counts.
    if (bars && lag == 0.0) continue;
    trace.x.push_back(lag);
    trace.y.push_back(values[i]);
    size = std::max(size, std::abs(lag));
  }
  const ReadableUnit unit = readable_unit(size, "s");
  for (double& x : trace.x) x /= unit.si;
  Plot plot = small_plot(title, fmt::format("lag [{}]", unit.name), title);
  plot.traces = {std::move(trace)};
  const double band = curve.at("band").get<double>();
  plot.levels = {-band, band};
  return plot;
}

std::vector<Plot> test_plots(const Json& curves, std::string_view channel_unit_name) {
  std::vector<Plot> plots;
  plots.push_back(correlation_plot(curves.at("autocorrelation"), "autocorrelation", true));
  if (curves.at("cross_correlation").is_object()) {
    plots.push_back(
        correlation_plot(curves.at("cross_correlation"), "cross-correlation with input", false));
  }
  Plot power = small_plot("periodogram", "frequency [Hz]",
                          fmt::format("power density [{}^2/Hz]", channel_unit_name));
  power.log_x = true;
  power.log_y = true;
  Trace density;
  density.style = "residual";
  density.x = numbers_of(curves.at("periodogram").at("frequency_hz"));
  density.y = numbers_of(curves.at("periodogram").at("density"));
  power.traces = {std::move(density)};
  plots.push_back(std::move(power));
  Plot quantiles = small_plot("quantiles", "normal quantile", "residual quantile [std]");
  Trace line;
  line.style = "reference";
  Trace points;
  points.kind = Trace::Kind::points;
  points.style = "residual";
  points.x = numbers_of(curves.at("normality").at("normal_quantile"));
  points.y = numbers_of(curves.at("normality").at("residual_quantile"));
  line.x = line.y = {points.x.front(), points.x.back()};
  quantiles.traces = {std::move(line), std::move(points)};
  plots.push_back(std::move(quantiles));
  return plots;
}

struct TestName {
  const char* key;
  const char* name;
};
constexpr std::array kTests{TestName{"autocorrelation", "Autocorrelation"},
                            TestName{"cross_correlation", "Cross-correlation with the input"},
                            TestName{"periodogram", "Periodogram"},
                            TestName{"normality", "Normality"}, TestName{"drift", "Drift"}};

struct TestMark {
  const char* mark;
  const char* style;
  const char* word;  ///< for who does not see the mark
};

const TestMark& mark_of(const Json& passed) {
  static constexpr TestMark kPassed{"✓", "good", "passed"};
  static constexpr TestMark kFailed{"!", "warn", "failed"};
  static constexpr TestMark kNotJudged{"○", "none", "cannot be judged"};
  if (!passed.is_boolean()) return kNotJudged;
  return passed.get<bool>() ? kPassed : kFailed;
}

}  // namespace

Json tests_view(const Json& condition, const Json& curves) {
  Json list = Json::array();
  for (const auto& [channel, tests] : condition.at("residual_tests").items()) {
    Json view{{"channel", channel}, {"rows", Json::array()}, {"plots", Json::array()}};
    view["known"] = tests.is_object();
    if (!tests.is_object()) {
      list.push_back(std::move(view));
      continue;
    }
    for (const TestName& test : kTests) {
      const Json& found = tests.at(test.key);
      if (!found.is_object()) continue;
      const TestMark& mark = mark_of(found.at("passed"));
      view["rows"].push_back({{"name", test.name},
                              {"mark", mark.mark},
                              {"class", mark.style},
                              {"word", mark.word},
                              {"verdict", text_of(found, "verdict")}});
    }
    if (curves.is_object() && curves.contains(channel) && curves.at(channel).is_object()) {
      for (const Plot& plot : test_plots(curves.at(channel), channel_unit(channel)))
        view["plots"].push_back({{"svg_html", svg(plot)}});
    }
    list.push_back(std::move(view));
  }
  return list;
}

}  // namespace rigcal::report
