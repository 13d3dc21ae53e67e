#include <fmt/format.h>

#include <algorithm>

#include "report/figure/time_plots.hpp"
#include "report/page/calibration/page_agreement_figures.hpp"
#include "report/page/calibration/score_columns.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Of the scores of a channel; null where it is not known.
const StoredAgreement* uncertainty_of(const StoredCondition& condition,
                                      const std::string& channel) {
  if (!condition.expanded_uncertainty) return nullptr;
  const auto* found = find(*condition.expanded_uncertainty, channel);
  return found != nullptr && found->has_value() ? &**found : nullptr;
}

/// Of a table of scores: channel, noise ceiling, gain, phase, delay.
constexpr std::size_t kOtherColumns = 5;

Json score_rows(const StoredCondition& condition) {
  Json rows = Json::array();
  for (const auto& [channel, scores] : condition.metrics) {
    const std::string_view unit = channel_unit(channel);
    const auto* floor = find(condition.noise_floor, channel);
    const bool has_floor = floor != nullptr && floor->has_value();
    rows.push_back(
        {{"channel", channel},
         {"badge", badge(condition.verdict_of(channel))},
         {"cells", score_cells(scores, uncertainty_of(condition, channel), unit)},
         {"floor", shown_agreement(has_floor ? std::optional((*floor)->rho2) : std::nullopt)},
         {"gain", shown_in(scores.gain_ratio, 1.0, 5)},
         {"phase", shown_in(scores.phase_deg, 1.0, 2)},
         {"delay", shown(scores.delay_s, "s", 2)},
         {"problem", scores.problem.value_or("")},
         {"has_problem", scores.problem.has_value()}});
  }
  return rows;
}

Json facts_of(const StoredCondition& condition) {
  Json facts = Json::array();
  const auto add = [&](const std::string& text) { facts.push_back({{"text", text}}); };
  if (condition.waveform) add(std::string(to_string(*condition.waveform)));
  const auto quantity = [&](const std::optional<double>& value, const char* unit,
                            const char* name) {
    if (value) add(fmt::format("{}{}", name, readable(*value, unit, 5)));
  };
  quantity(condition.frequency_hz, "Hz", "");
  quantity(condition.amplitude_m, "m", "amplitude ");
  quantity(condition.amplitude_v.value_or(std::nullopt), "V", "amplitude ");
  quantity(condition.amplitude_n, "N", "amplitude ");
  quantity(condition.amplitude_pa, "Pa", "amplitude ");
  quantity(condition.amplitude_m_per_s2, "m/s2", "amplitude ");
  if (condition.leak_level) add("leak " + *condition.leak_level);
  if (condition.temperature_k) add(fmt::format("{:.4g} °C", *condition.temperature_k - 273.15));
  if (condition.date) add(*condition.date);
  add("used to " + std::string(to_string(condition.use)));
  add(fmt::format("{} samples", condition.samples));
  return facts;
}

Json texts_view(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back({{"text", text}});
  return list;
}

}  // namespace

std::vector<Figure> condition_figures(const StoredCondition& condition, const Table& series) {
  std::vector<Figure> figures;
  if (series.columns.empty() || series.columns.front().empty()) return figures;
  for (const TimePlot& plot : time_plots(series))
    figures.push_back({plot.name, picture(plot, series, condition.id)});
  for (ChannelAgreement& channel :
       channel_agreements(condition.id, periodic_frequency(condition), series)) {
    for (Figure& figure : channel.figures) figures.push_back(std::move(figure));
  }
  return figures;
}

Json condition_view(const StoredCondition& condition, const Table& series,
                    const StoredChannelCurves* curves, std::size_t points) {
  const std::string& id = condition.id;
  Json view;
  view["id"] = id;
  view["not_scored"] = condition.not_scored.value_or("");
  view["is_not_scored"] = condition.not_scored.has_value();
  view["anchor"] = anchor(id);
  view["badge"] = badge(condition.verdict);
  view["failure"] = condition.failure.value_or("");
  view["failed"] = condition.failure.has_value();
  view["facts"] = facts_of(condition);
  view["reasons"] = texts_view(condition.reasons);
  view["has_reasons"] = !condition.reasons.empty();
  view["doubts"] = texts_view(condition.warnings);
  view["has_doubts"] = !condition.warnings.empty();
  view["metrics"] = score_titles();
  view["score_columns"] = fmt::format("{}", view["metrics"].size() + kOtherColumns);
  view["scores"] = score_rows(condition);
  view["has_scores"] = !view["scores"].empty();
  view["has_uncertainty"] = std::any_of(
      condition.metrics.begin(), condition.metrics.end(),
      [&](const auto& each) { return uncertainty_of(condition, each.first) != nullptr; });
  view["plots"] = Json::array();
  view["has_plots"] = false;
  if (!series.columns.empty() && !series.columns.front().empty()) {
    SeriesData data(series, points);
    Json& plots = data.json()["plots"] = Json::array();
    for (const TimePlot& plot : time_plots(series)) {
      Json lines = Json::array();
      for (const TimeLine& line : plot.lines) {
        lines.push_back({{"column", data.add(*line.values, plot.si)},
                         {"name", line.name},
                         {"style", line.style}});
      }
      Json entry{{"name", plot.name}, {"unit", plot.unit}, {"height", plot.height}};
      entry["lines"] = std::move(lines);
      entry["sd"] = plot.sd != nullptr
                        ? Json(data.add(*plot.sd, *plot.lines.front().values, plot.si))
                        : Json(nullptr);
      entry["prediction"] = nullptr;
      if (plot.prediction_sd != nullptr) {
        const auto& middle =
            plot.prediction_middle != nullptr ? *plot.prediction_middle : *plot.prediction_sd;
        const auto line = std::find_if(plot.lines.begin(), plot.lines.end(), [&](const auto& each) {
          return each.values == plot.prediction_middle;
        });
        entry["prediction"] = {
            {"sd", data.add(*plot.prediction_sd, middle, plot.si)},
            {"middle",
             line == plot.lines.end()
                 ? Json(nullptr)
                 : entry["lines"][static_cast<std::size_t>(line - plot.lines.begin())]["column"]},
            {"factor", kNormal95}};
      }
      plots.push_back(std::move(entry));
      view["plots"].push_back({{"name", plot.name},
                               {"title", plot.title},
                               {"unit", plot.unit},
                               {"number", fmt::format("{}", plots.size() - 1)},
                               {"description", description(plot, series)},
                               {"svg_html", svg(picture(plot, series, id))}});
    }
    view["has_plots"] = !view["plots"].empty();
    view["thinned"] = data.json()["samples_per_point"].get<std::size_t>() > 1;
    view["samples_per_point"] =
        fmt::format("{}", data.json()["samples_per_point"].get<std::size_t>());
    view["data_html"] = data.text();
  }
  // A condition that was scored has a series; without it the page would only look complete.
  view["lost"] = view["has_scores"].get<bool>() && !view["has_plots"].get<bool>();
  view["agreement"] = agreement_view(id, periodic_frequency(condition), series);
  view["has_agreement"] = !view["agreement"].empty();
  view["tests"] = tests_view(condition, curves);
  view["has_tests"] = !view["tests"].empty();
  view["has_curves"] = view["has_plots"].get<bool>() || view["has_tests"].get<bool>();
  const std::size_t plots = view["plots"].size();
  view["curves"] =
      fmt::format("Curves and residual tests ({} plot{} over time)", plots, plots == 1 ? "" : "s");
  return view;
}

}  // namespace rigcal::report
