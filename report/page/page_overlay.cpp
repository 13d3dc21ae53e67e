#include "report/page/page_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/record.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// In the order of the results; from the sixth on they come again.
constexpr std::array kResultStyles{"model", "residual", "servo", "leak", "reference"};

double largest_of(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) result = std::max(result, std::abs(value));
  return result;
}

Plot time_plot(const std::string& title, const std::string& y_label, double height) {
  Plot plot;
  plot.title = title;
  plot.x_label = "time [s]";
  plot.y_label = y_label;
  plot.width = 620.0;
  plot.height = height;
  return plot;
}

}  // namespace

std::vector<Figure> overlay_figures(const std::string& condition, const Table& curves,
                                    const std::vector<std::string>& names) {
  std::vector<Figure> figures;
  const auto* time_s = curves.find("time_s");
  if (time_s == nullptr) return figures;
  for (const datasets::ChannelInfo& about : datasets::channel_table()) {
    const auto* measured = curves.find(fmt::format("measured_{}", about.name));
    if (measured == nullptr) continue;
    std::string words(about.key);
    std::replace(words.begin(), words.end(), '_', ' ');
    const ReadableUnit unit = readable_unit(largest_of(*measured), about.unit);
    std::vector<Trace> models;
    std::vector<Trace> residuals;
    double largest_residual = 0.0;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto* simulated = curves.find(fmt::format("simulated_{}_{}", about.name, k + 1));
      if (simulated == nullptr) continue;
      const std::string style = kResultStyles[k % kResultStyles.size()];
      const std::string name = fmt::format("{}", k + 1);
      Trace model = empty_trace(Trace::Kind::line, style, name);
      Trace residual = empty_trace(Trace::Kind::line, style, name);
      model.x = residual.x = *time_s;
      for (std::size_t i = 0; i < measured->size(); ++i) {
        model.y.push_back((*simulated)[i] / unit.si);
        residual.y.push_back((*measured)[i] - (*simulated)[i]);
      }
      largest_residual = std::max(largest_residual, largest_of(residual.y));
      models.push_back(std::move(model));
      residuals.push_back(std::move(residual));
    }
    if (models.size() < 2) continue;
    const auto labelled = [](const std::string& what, const ReadableUnit& of) {
      return fmt::format("{} [{}]", what, of.name.empty() ? "1" : of.name);
    };
    Plot both =
        time_plot(fmt::format("{} of {}, measured and the models of the results", words, condition),
                  labelled(words, unit), 200.0);
    Trace record = empty_trace(Trace::Kind::line, "measured", "measured");
    record.x = *time_s;
    for (const double value : *measured) record.y.push_back(value / unit.si);
    both.traces = std::move(models);
    both.traces.insert(both.traces.begin(), std::move(record));
    figures.push_back({fmt::format("{}_{}", condition, about.key), std::move(both)});
    const ReadableUnit rest = readable_unit(largest_residual, about.unit);
    Plot left = time_plot(fmt::format("residual of {} of {}, by result", words, condition),
                          labelled("residual", rest), 150.0);
    for (Trace& trace : residuals)
      for (double& value : trace.y) value /= rest.si;
    left.traces = std::move(residuals);
    figures.push_back({fmt::format("{}_{}_residual", condition, about.key), std::move(left)});
  }
  return figures;
}

Json overlays_view(const std::vector<std::pair<std::string, Table>>& curves,
                   const std::vector<std::string>& names) {
  Json view = Json::array();
  for (const auto& [condition, table] : curves) {
    Json figures = Json::array();
    for (const Figure& figure : overlay_figures(condition, table, names))
      figures.push_back({{"svg_html", svg(figure.plot)}});
    if (figures.empty()) continue;
    view.push_back({{"condition", condition},
                    {"open", curves.size() <= kFew},
                    {"figures", std::move(figures)}});
  }
  return view;
}

}  // namespace rigcal::report
