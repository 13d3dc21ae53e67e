#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

constexpr double kHighestRise = 4.0;

std::string end_words(const StoredProfileEnd& end, const RowUnit& unit, const char* which) {
  const auto text = [&](double value) {
    return fmt::format("{:.5g}{}{}", value / unit.si, unit.name.empty() ? "" : " ", unit.name);
  };
  if (end.value) return fmt::format("{} end {}", which, text(*end.value));
  if (end.lost.value_or(false))
    return fmt::format("not followed to its {} end: stopped, or no fit there", which);
  return fmt::format(
      "open at its {} end{}", which,
      end.reached ? fmt::format(": followed to {} without leaving the interval", text(*end.reached))
                  : std::string());
}

/// How much worse the fit gets with a parameter held; 1 ends the 95 % interval.
Json profile_view(const StoredParameter& parameter, const StoredProfile& profile) {
  const RowUnit unit = unit_of(parameter);
  Plot plot;
  plot.title = fmt::format("Profile of {}", parameter_label(parameter));
  plot.x_label = unit.name.empty() ? parameter_label(parameter)
                                   : fmt::format("{} [{}]", parameter_label(parameter), unit.name);
  plot.y_label = "rise of the cost; 1: end of the interval";
  plot.width = 300.0;
  plot.height = 170.0;
  plot.levels = {1.0};
  Trace trace;
  trace.style = "reference";
  for (std::size_t i = 0; i < std::min(profile.values.size(), profile.rises.size()); ++i) {
    if (std::isnan(profile.values[i]) || std::isnan(profile.rises[i])) continue;
    // Far beyond the end it would only flatten what counts.
    if (profile.rises[i] > kHighestRise) continue;
    trace.x.push_back(profile.values[i] / unit.si);
    trace.y.push_back(profile.rises[i]);
  }
  Trace points = trace;
  points.kind = Trace::Kind::points;
  points.style = "model";
  plot.traces = {std::move(trace), std::move(points)};
  return {{"svg_html", svg(plot)},
          {"reading", fmt::format("{}: {}, {}.", parameter_label(parameter),
                                  end_words(profile.low, unit, "lower"),
                                  end_words(profile.high, unit, "upper"))}};
}

Json bootstrap_row(const StoredParameter& parameter, const StoredBootstrap& bootstrap) {
  const RowUnit unit = unit_of(parameter);
  const auto& ci95 = bootstrap.ci95;
  return {{"name", parameter_label(parameter)},
          {"unit", unit.name},
          {"value", shown_in(parameter.value, unit.si, 6)},
          {"standard_error", shown_in(bootstrap.standard_error, unit.si, 3)},
          {"bias", shown_in(bootstrap.bias, unit.si, 3)},
          {"low", shown_in(ci95 ? std::optional(ci95->low) : std::nullopt, unit.si, 5)},
          {"high", shown_in(ci95 ? std::optional(ci95->high) : std::nullopt, unit.si, 5)}};
}

Json lack_of_fit_rows(const StoredLackOfFit& lack) {
  Json rows = Json::array();
  for (const StoredLackOfFitTest& test : lack.tests) {
    const bool judged = test.outcome != metrics::TestOutcome::not_judged;
    rows.push_back({{"condition", test.condition},
                    {"channel", test.channel},
                    {"against", test.against},
                    {"ratio", shown_in(test.ratio, 1.0, 4)},
                    {"freedom", shown_in(test.freedom, 1.0, 6)},
                    {"p", std::isnan(test.p) ? std::string("–") : p_value_text(test.p)},
                    {"outcome", judged ? std::string(to_string(test.outcome))
                                       : "cannot be judged: " + test.reason.value_or("")}});
  }
  return rows;
}

Json lack_of_fit_view(const StoredFit& fit) {
  const StoredLackOfFit lack = fit.lack_of_fit.value_or(StoredLackOfFit());
  Json view;
  view["sentence"] = lack.misfit == true    ? "Significant lack of fit."
                     : lack.misfit == false ? "No lack of fit detected."
                     : !lack.tests.empty()
                         ? "Lack of fit cannot be judged: the records have too few "
                           "independent samples."
                         : "Lack of fit cannot be judged: the noise is not known.";
  view["class"] = lack.misfit == true ? "warn" : lack.misfit == false ? "good" : "none";
  view["rows"] = lack_of_fit_rows(lack);
  view["known"] = fit.lack_of_fit.has_value() && fit.status != calib::FitStatus::failed;
  view["has_rows"] = !lack.tests.empty();
  view["row_count"] = fmt::format("{}", lack.tests.size());
  return view;
}

/// "27.05 um (27.01 um where it was fitted)" per channel.
std::string prediction_words(const StoredHeldOut& held) {
  std::string text;
  for (const auto& [channel, value] : held.rmse) {
    if (std::isnan(value)) continue;
    const double* fitted = find(held.fitted_rmse, channel);
    const std::string unit(channel_unit(channel));
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", channel, readable(value, unit, 4));
    if (fitted != nullptr && !std::isnan(*fitted))
      text += fmt::format(" ({} where it was fitted)", readable(*fitted, unit, 4));
  }
  return text;
}

Json cross_validation_rows(const StoredFit& fit) {
  Json rows = Json::array();
  if (!fit.cross_validation) return rows;
  for (const StoredHeldOut& held : *fit.cross_validation) {
    const auto& shift = held.largest_shift;
    rows.push_back({{"condition", held.condition},
                    {"prediction", held.problem ? *held.problem : prediction_words(held)},
                    {"shifted", held.shifted.value_or("")},
                    {"shift", shift ? fmt::format("{:.2g}", *shift) : std::string("–")}});
  }
  return rows;
}

Json basin_rows(const std::vector<StoredBasin>& basins) {
  Json rows = Json::array();
  for (const StoredBasin& basin : basins)
    rows.push_back({{"cost", shown_in(basin.cost, 1.0, 8)},
                    {"starts", fmt::format("{}", basin.starts.size())}});
  return rows;
}

}  // namespace

Json trust_view(const StoredFit& fit) {
  Json view;
  view["profiles"] = Json::array();
  view["bootstraps"] = Json::array();
  for (const StoredParameter& p : fit.parameters) {
    if (p.profile) view["profiles"].push_back(profile_view(p, *p.profile));
    if (p.bootstrap) view["bootstraps"].push_back(bootstrap_row(p, *p.bootstrap));
  }
  view["has_profiles"] = !view["profiles"].empty();
  view["has_bootstraps"] = !view["bootstraps"].empty();
  view["bootstrap_message"] = fit.bootstrap ? fit.bootstrap->message : std::string();
  view["advice"] = fit.interval_advice;
  view["has_advice"] = !fit.interval_advice.empty();
  view["combinations"] = json_of(fit.combinations);
  view["has_combinations"] = !fit.combinations.empty();
  view["lack"] = lack_of_fit_view(fit);
  view["cross_validation"] = cross_validation_rows(fit);
  view["has_cross_validation"] = !view["cross_validation"].empty();
  view["agreement"] = fit.agreement;
  view["has_agreement"] = !fit.agreement.empty();
  view["basins"] = basin_rows(fit.basins);
  view["has_basins"] = fit.basins.size() > 1;
  view["has_criteria"] = fit.aic && fit.bic;
  if (fit.aic && fit.bic)
    view["criteria"] = fmt::format("AIC {:.6g}, BIC {:.6g}", *fit.aic, *fit.bic);
  return view;
}

}  // namespace rigcal::report
