#include <fmt/format.h>

#include <algorithm>

#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

constexpr double kHighestRise = 4.0;

/// A key that not every fit has; null where it is missing.
const Json& optional_part(const Json& json, const char* key) {
  static const Json kNothing;
  const auto found = json.find(key);
  return found == json.end() ? kNothing : *found;
}

std::string end_words(const Json& end, const RowUnit& unit, const char* which) {
  const auto text = [&](double value) {
    return fmt::format("{:.5g}{}{}", value / unit.si, unit.name.empty() ? "" : " ", unit.name);
  };
  if (const auto value = number_of(end, "value"))
    return fmt::format("{} end {}", which, text(*value));
  const auto reached = number_of(end, "reached");
  if (end.value("lost", false))
    return fmt::format("not followed to its {} end: stopped, or no fit there", which);
  return fmt::format(
      "open at its {} end{}", which,
      reached ? fmt::format(": followed to {} without leaving the interval", text(*reached))
              : std::string());
}

/// How much worse the fit gets with a parameter held; 1 ends the 95 % interval.
Json profile_view(const Json& parameter) {
  const Json& profile = parameter.at("profile");
  const RowUnit unit = row_unit(number_of(parameter, "value").value_or(0.0), parameter);
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
  const Json& values = profile.at("values");
  const Json& rises = profile.at("rises");
  for (std::size_t i = 0; i < std::min(values.size(), rises.size()); ++i) {
    if (!values.at(i).is_number() || !rises.at(i).is_number()) continue;
    // Far beyond the end it would only flatten what counts.
    if (rises.at(i).get<double>() > kHighestRise) continue;
    trace.x.push_back(values.at(i).get<double>() / unit.si);
    trace.y.push_back(rises.at(i).get<double>());
  }
  Trace points = trace;
  points.kind = Trace::Kind::points;
  points.style = "model";
  plot.traces = {std::move(trace), std::move(points)};
  return {{"svg_html", svg(plot)},
          {"reading", fmt::format("{}: {}, {}.", parameter_label(parameter),
                                  end_words(profile.at("low"), unit, "lower"),
                                  end_words(profile.at("high"), unit, "upper"))}};
}

Json bootstrap_row(const Json& parameter) {
  const Json& bootstrap = parameter.at("bootstrap");
  const RowUnit unit = row_unit(number_of(parameter, "value").value_or(0.0), parameter);
  const Json& ci = bootstrap.at("ci95");
  return {{"name", parameter_label(parameter)},
          {"unit", unit.name},
          {"value", shown_in(parameter.at("value"), unit.si, 6)},
          {"standard_error", shown_in(bootstrap.at("standard_error"), unit.si, 3)},
          {"bias", shown_in(bootstrap.at("bias"), unit.si, 3)},
          {"low", shown_in(ci.at(0), unit.si, 5)},
          {"high", shown_in(ci.at(1), unit.si, 5)}};
}

Json lack_of_fit_view(const Json& lack) {
  Json view;
  const Json& misfit = optional_part(lack, "misfit");
  const bool tested = !optional_part(lack, "tests").empty();
  view["sentence"] = misfit == true    ? "Significant lack of fit."
                     : misfit == false ? "No lack of fit detected."
                     : tested          ? "Lack of fit cannot be judged: the records have too few "
                                         "independent samples."
                                       : "Lack of fit cannot be judged: the noise is not known.";
  view["class"] = misfit == true ? "warn" : misfit == false ? "good" : "none";
  view["rows"] = Json::array();
  for (const Json& test : optional_part(lack, "tests")) {
    const auto p = number_of(test, "p");
    view["rows"].push_back({{"condition", text_of(test, "condition")},
                            {"channel", text_of(test, "channel")},
                            {"against", text_of(test, "against")},
                            {"ratio", shown_in(test.at("ratio"), 1.0, 4)},
                            {"freedom", shown_in(test.at("freedom"), 1.0, 6)},
                            {"p", p ? p_value_text(*p) : std::string("–")},
                            {"outcome", text_of(test, "outcome") == "not_judged"
                                            ? "cannot be judged: " + text_of(test, "reason")
                                            : text_of(test, "outcome")}});
  }
  view["row_count"] = fmt::format("{}", view["rows"].size());
  view["known"] = lack.is_object();
  view["has_rows"] = !view["rows"].empty();
  return view;
}

/// "27.05 um (27.01 um where it was fitted)" per channel.
std::string prediction_words(const Json& held) {
  std::string text;
  for (const auto& [channel, value] : held.at("rmse").items()) {
    if (!value.is_number()) continue;
    const auto fitted = number_of(held.at("fitted_rmse"), channel);
    const std::string unit(channel_unit(channel));
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", channel,
                        readable(value.get<double>(), unit, 4));
    if (fitted) text += fmt::format(" ({} where it was fitted)", readable(*fitted, unit, 4));
  }
  return text;
}

Json cross_validation_rows(const Json& list) {
  Json rows = Json::array();
  for (const Json& held : list) {
    const std::string problem = text_of(held, "problem");
    const auto shift = number_of(held, "largest_shift");
    rows.push_back({{"condition", text_of(held, "condition")},
                    {"prediction", problem.empty() ? prediction_words(held) : problem},
                    {"shifted", text_of(held, "shifted")},
                    {"shift", shift ? fmt::format("{:.2g}", *shift) : std::string("–")}});
  }
  return rows;
}

Json basin_rows(const Json& basins) {
  Json rows = Json::array();
  for (const Json& basin : basins) {
    const Json& starts = basin.at("starts");
    rows.push_back({{"cost", shown_in(basin.at("cost"), 1.0, 8)},
                    {"starts", fmt::format("{}", starts.is_array() ? starts.size()
                                                                   : starts.get<std::size_t>())}});
  }
  return rows;
}

}  // namespace

Json trust_view(const Json& result) {
  Json view;
  view["profiles"] = Json::array();
  view["bootstraps"] = Json::array();
  for (const Json& parameter : result.at("parameters")) {
    if (optional_part(parameter, "profile").is_object())
      view["profiles"].push_back(profile_view(parameter));
    if (optional_part(parameter, "bootstrap").is_object())
      view["bootstraps"].push_back(bootstrap_row(parameter));
  }
  view["has_profiles"] = !view["profiles"].empty();
  view["has_bootstraps"] = !view["bootstraps"].empty();
  view["bootstrap_message"] = text_of(optional_part(result, "bootstrap"), "message");
  view["advice"] = text_of(result, "interval_advice");
  view["has_advice"] = !text_of(result, "interval_advice").empty();
  const Json& combinations = optional_part(result, "combinations");
  view["combinations"] = combinations.is_array() ? combinations : Json::array();
  view["has_combinations"] = !view["combinations"].empty();
  view["lack"] = lack_of_fit_view(optional_part(result, "lack_of_fit"));
  if (text_of(result, "status") == "failed") view["lack"]["known"] = false;
  view["cross_validation"] = cross_validation_rows(optional_part(result, "cross_validation"));
  view["has_cross_validation"] = !view["cross_validation"].empty();
  view["agreement"] = text_of(result, "agreement");
  view["has_agreement"] = !text_of(result, "agreement").empty();
  view["basins"] = basin_rows(optional_part(result, "basins"));
  view["has_basins"] = view["basins"].size() > 1;
  const auto aic = number_of(result, "aic");
  const auto bic = number_of(result, "bic");
  view["has_criteria"] = aic && bic;
  if (aic && bic) view["criteria"] = fmt::format("AIC {:.6g}, BIC {:.6g}", *aic, *bic);
  return view;
}

}  // namespace rigcal::report
