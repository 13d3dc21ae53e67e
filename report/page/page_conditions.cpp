#include <fmt/format.h>

#include <algorithm>

#include "report/figure/time_plots.hpp"
#include "report/page/page_agreement_figures.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Json score_rows(const Json& condition) {
  Json rows = Json::array();
  for (const auto& [channel, scores] : condition.at("metrics").items()) {
    const std::string_view unit = channel_unit(channel);
    const auto floors = condition.at("noise_floor").find(channel);
    const bool floor = floors != condition.at("noise_floor").end() && floors->is_object();
    rows.push_back({{"channel", channel},
                    {"badge", badge(channel_verdict(condition, channel))},
                    {"rho2", shown_agreement(scores.at("rho2"))},
                    {"r", shown_agreement(scores.at("r"))},
                    {"ccc", shown_agreement(scores.at("ccc"))},
                    {"error", shown_in(scores.at("absolute_error_percent"), 1.0, 4)},
                    {"fit", shown_in(scores.at("nrmse_fit_percent"), 1.0, 5)},
                    {"rmse", shown(scores.at("rmse"), unit, 4)},
                    {"maximum", shown(scores.at("maximum_error"), unit, 4)},
                    {"floor", shown_agreement(floor ? floors->at("rho2") : Json())},
                    {"gain", shown_in(scores.at("gain_ratio"), 1.0, 5)},
                    {"phase", shown_in(scores.at("phase_deg"), 1.0, 2)},
                    {"delay", shown(scores.at("delay_s"), "s", 2)},
                    {"problem", text_of(scores, "problem")},
                    {"has_problem", !text_of(scores, "problem").empty()}});
  }
  return rows;
}

Json facts_of(const Json& condition) {
  Json facts = Json::array();
  const auto add = [&](const std::string& text) { facts.push_back({{"text", text}}); };
  if (const std::string waveform = text_of(condition, "waveform"); !waveform.empty()) add(waveform);
  const auto quantity = [&](const char* key, const char* unit, const char* name) {
    if (const auto value = number_of(condition, key))
      add(fmt::format("{}{}", name, readable(*value, unit, 5)));
  };
  quantity("frequency_hz", "Hz", "");
  quantity("amplitude_m", "m", "amplitude ");
  quantity("amplitude_v", "V", "amplitude ");
  if (const std::string level = text_of(condition, "leak_level"); !level.empty())
    add("leak " + level);
  if (const auto kelvin = number_of(condition, "temperature_k"))
    add(fmt::format("{:.4g} °C", *kelvin - 273.15));
  if (const std::string date = text_of(condition, "date"); !date.empty()) add(date);
  add("used to " + text_of(condition, "use"));
  add(fmt::format("{} samples", condition.at("samples").get<long>()));
  return facts;
}

}  // namespace

std::vector<Figure> condition_figures(const Json& condition, const Table& series) {
  std::vector<Figure> figures;
  if (series.columns.empty() || series.columns.front().empty()) return figures;
  for (const TimePlot& plot : time_plots(series))
    figures.push_back({plot.name, picture(plot, series, text_of(condition, "id"))});
  for (ChannelAgreement& channel :
       channel_agreements(text_of(condition, "id"), periodic_frequency(condition), series)) {
    for (Figure& figure : channel.figures) figures.push_back(std::move(figure));
  }
  return figures;
}

Json condition_view(const Json& condition, const Table& series, const Json& curves,
                    std::size_t points) {
  const std::string id = text_of(condition, "id");
  Json view;
  view["id"] = id;
  view["not_scored"] = text_of(condition, "not_scored");
  view["is_not_scored"] = !text_of(condition, "not_scored").empty();
  view["anchor"] = anchor(id);
  view["badge"] = badge(condition.at("verdict"));
  view["failure"] = text_of(condition, "failure");
  view["failed"] = !text_of(condition, "failure").empty();
  view["facts"] = facts_of(condition);
  view["reasons"] = Json::array();
  for (const Json& reason : condition.at("reasons")) view["reasons"].push_back({{"text", reason}});
  view["has_reasons"] = !condition.at("reasons").empty();
  view["doubts"] = Json::array();
  if (const auto doubts = condition.find("warnings"); doubts != condition.end())
    for (const Json& doubt : *doubts) view["doubts"].push_back({{"text", doubt}});
  view["has_doubts"] = !view["doubts"].empty();
  view["scores"] = score_rows(condition);
  view["has_scores"] = !view["scores"].empty();
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
