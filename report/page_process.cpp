#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/metric_table.hpp"
#include "report/page_parts.hpp"

namespace rigcal::report {
namespace {

struct Formula {
  const char* name;
  const char* formula;
};

/// What the page shows beside the metrics of metrics/metric_table.hpp.
constexpr std::array kFormulas{
    Formula{"noise floor",
            "what a model equal to the true signal would score: rho2 = 1 - sigma^2 / "
            "var(y), sigma the standard deviation of the mean of the repeats"},
    Formula{"gain ratio, phase, delay",
            "simulated over measured amplitude, and phase, of the least-"
            "squares sine at the fundamental; delay = -phase / (360 f)"},
    Formula{"cost",
            "half the sum over all samples and channels of ((s - y) / sigma)^2, priors "
            "included"},
    Formula{"reduced chi-square", "2 cost / (residuals - rank); 1 where the noise explains all"},
    Formula{"standard error",
            "root of the diagonal of max(1, chi-square) (J'J)^-1, J the Jacobian of "
            "the weighted residuals"},
    Formula{"robust standard error",
            "sandwich (J'J)^-1 S (J'J)^-1, S from the scatter of the "
            "residuals, correlated in time as they are"},
    Formula{"95 % interval",
            "value ± t times the standard error, with the robust one where that is "
            "clearly larger, cut at the limits of the parameter"},
    Formula{"identified, weak, not identifiable",
            "half width of the interval up to 20 %, up to "
            "100 %, above 100 % of the value"},
    Formula{"singular values",
            "of J with columns of length 1; a direction whose value is nil is not "
            "determined"},
    Formula{"autocorrelation",
            "rho(k) = sum e(t) e(t-k) / sum e^2; band ± 1.96 / sqrt(n); test of "
            "Ljung and Box over 25 lags"},
    Formula{"effective samples", "n / (1 + 2 sum of rho) up to the first rho that is not positive"},
    Formula{"cross-correlation",
            "sum e(t) u(t-lag) / (n std(e) std(u)), u the reference or command; "
            "band by the effective samples, Bonferroni for the peak"},
    Formula{"periodogram",
            "power of each line of the Fourier transform, averaged over 30 bins a "
            "decade; test of the cumulative periodogram (Bartlett)"},
    Formula{"quantiles",
            "of (e - mean) / std over those of the normal distribution; test of Jarque "
            "and Bera with the effective samples"},
    Formula{"drift",
            "mean and least-squares slope of e, each against its standard error by the "
            "effective samples"},
    Formula{"share of the servo flow",
            "mean |Q_leak| / mean |Q_servo| of the model, over whole periods; a leak table looks "
            "for all coefficients at which it is the target"},
    Formula{"class of a leak",
            "by the share's place between the limits; probabilities by the share's interval, "
            "given that it is not negative (docs/diagnosis.md)"},
    Formula{"smallest leak",
            "told from none with the stated false alarms, and found in the stated share of cases "
            "(Currie's detection limit)"},
    Formula{"difference, p",
            "two-sided, of (b - a) / root of the sum of the squared errors, each the larger of "
            "standard and robust; for all parameters together by Holm's steps"},
    Formula{"trend",
            "weighted least squares; its error is widened by the root of reduced chi-square where "
            "that exceeds 1, t with n - 2 degrees of freedom"},
    Formula{"sign test", "exact binomial, two-sided, over the conditions that both results have"},
};

}  // namespace

Json starts_view(const Json& result) {
  Json view;
  const Json& starts = result.at("starts");
  view["known"] = !starts.empty();
  view["rows"] = Json::array();
  const int best = result.at("best_start").get<int>();
  std::vector<double> costs;
  double least = HUGE_VAL;
  for (const Json& start : starts) {
    const auto cost = number_of(start, "final_cost");
    const int number = start.at("number").get<int>();
    view["rows"].push_back({{"number", fmt::format("{}", number)},
                            {"best", number == best},
                            {"status", text_of(start, "status")},
                            {"initial_cost", shown_in(start.at("initial_cost"), 1.0, 6)},
                            {"final_cost", shown_in(start.at("final_cost"), 1.0, 6)},
                            {"iterations", fmt::format("{}", start.at("iterations").get<int>())},
                            {"message", text_of(start, "message")}});
    if (!cost || text_of(start, "status") == "failed") continue;
    costs.push_back(*cost);
    least = std::min(least, *cost);
  }
  std::sort(costs.begin(), costs.end());
  const auto near =
      std::count_if(costs.begin(), costs.end(), [&](double cost) { return cost <= least * 1.01; });
  const std::size_t all = starts.size();
  if (all == 1) {
    view["reading"] = "One start alone: whether another minimum lies lower was not looked for.";
  } else {
    view["reading"] =
        fmt::format("{} of {} starts ended within 1 % of the lowest cost{}.", near, all,
                    near >= 2 ? ", so that the answer was found more than once"
                              : ": the answer was found once");
  }
  view["waterfall"] = costs.size() > 1;
  if (costs.size() > 1) {
    Plot plot;
    plot.title = "Cost of every start, sorted";
    plot.x_label = "start, best first; dashed: 1 % above the lowest";
    plot.whole_x = true;
    plot.levels = {1.01 * least};
    plot.y_label = "final cost";
    plot.log_y = true;
    plot.height = 170.0;
    Trace trace;
    trace.kind = Trace::Kind::points;
    trace.style = "model";
    for (std::size_t i = 0; i < costs.size(); ++i) {
      trace.x.push_back(static_cast<double>(i + 1));
      trace.y.push_back(costs[i]);
    }
    plot.traces = {trace};
    view["plot_html"] = svg(plot);
  }
  return view;
}

Json ledger_view(const Json& result) {
  Json view;
  view["warnings"] = Json::array();
  for (const Json& warning : result.at("warnings")) view["warnings"].push_back({{"text", warning}});
  view["has_warnings"] = !view["warnings"].empty();
  view["failures"] = Json::array();
  for (const Json& failure : result.at("failures")) {
    std::string values;
    for (const auto& [name, value] : failure.at("parameters").items()) {
      values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", name,
                            value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : "–");
    }
    view["failures"].push_back({{"condition", text_of(failure, "condition")},
                                {"start", fmt::format("{}", failure.at("start").get<int>())},
                                {"time", shown(failure.at("time_s"), "s", 5)},
                                {"reason", text_of(failure, "reason")},
                                {"values", values}});
  }
  view["has_failures"] = !view["failures"].empty();
  view["failure_count"] = fmt::format("{}", result.at("failure_count").get<long>());
  view["nothing"] = view["warnings"].empty() && view["failures"].empty();
  return view;
}

Json provenance_view(const Json& result, const std::string& name, const std::string& file) {
  const Json& provenance = result.at("provenance");
  Json view;
  view["name"] = name;
  view["file"] = file;
  view["command"] = text_of(provenance, "command");
  view["facts"] = Json::array();
  const auto add = [&](const std::string& fact, const std::string& value) {
    if (!value.empty()) view["facts"].push_back({{"name", fact}, {"value", value}});
  };
  const auto add_number = [&](const char* fact, const char* key, int digits, const char* unit) {
    if (const auto value = number_of(result, key))
      add(fact, fmt::format("{:.{}g}{}", *value, digits, unit));
  };
  add("Program", fmt::format("rigcal {}", text_of(provenance, "version")));
  add("Git revision", text_of(provenance, "revision"));
  add("Machine", text_of(provenance, "machine"));
  add("Seed", fmt::format("{}", provenance.at("seed").get<std::uint64_t>()));
  for (const auto& [option, value] : provenance.at("options").items())
    add("Option " + option, value.is_string() ? value.get<std::string>() : value.dump());
  add_number("Tolerance of the simulations", "simulation_tolerance", 3, "");
  add_number("Residuals", "residual_count", 12, "");
  add_number("Evaluations", "evaluations", 12, "");
  add_number("Time", "wall_seconds", 3, " s");
  add_number("Cost", "cost", 8, "");
  add_number("Reduced chi-square", "reduced_chi_square", 5, "");
  view["inputs"] = Json::array();
  for (const Json& input : provenance.at("inputs"))
    view["inputs"].push_back(
        {{"path", text_of(input, "path")}, {"sha256", text_of(input, "sha256")}});
  view["input_count"] = fmt::format("{}", view["inputs"].size());
  return view;
}

Json formulas_view() {
  Json rows = Json::array();
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    rows.push_back({{"name", metric.name}, {"formula", metric.formula}});
  for (const Formula& each : kFormulas)
    rows.push_back({{"name", each.name}, {"formula", each.formula}});
  return rows;
}

}  // namespace rigcal::report
