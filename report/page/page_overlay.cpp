#include "report/page/page_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "datasets/campaign/condition_id.hpp"
#include "datasets/record.hpp"
#include "report/figure/time_plots.hpp"
#include "report/store/result_files.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Style classes in the order of the results, reused from the sixth result on.
constexpr std::array kResultStyles{"model", "residual", "servo", "leak", "reference"};

Plot time_plot(const std::string& title, const std::string& y_label, double height) {
  return {title, "time [s]", y_label, 620.0, height};
}

std::vector<std::string> names_of_results(const StoredComparison& comparison) {
  std::vector<std::string> names;
  for (const StoredComparedResult& result : comparison.results) names.push_back(result.name);
  return names;
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
    const ReadableUnit unit = readable_unit(largest(*measured), about.unit);
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
      largest_residual = std::max(largest_residual, largest(residual.y));
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

ComparisonFiles load_comparison_files(const ReadFile& read, const std::string& where) {
  ComparisonFiles files{load_comparison(read, where), {}};
  const ReadFile own = files_of_run(read, files.result.provenance, where, "comparison.json");
  auto& curves = files.curves;
  for (const StoredComparedCondition& condition : files.result.conditions) {
    const std::string& id = condition.id;
    const auto same = [&](const auto& each) { return each.first == id; };
    if (!datasets::is_condition_id(id) || std::any_of(curves.begin(), curves.end(), same)) continue;
    if (const auto table = table_in(own, where, "overlay/" + id + ".csv"))
      curves.emplace_back(id, *table);
  }
  return files;
}

doc::Verdict comparison_headline(const ComparisonFiles& files) {
  return comparison_headline(files.result);
}

std::vector<doc::Section> comparison_sections(const ComparisonFiles& files) {
  std::vector<doc::Section> sections = comparison_sections(files.result);
  doc::Section curves{
      "curves",
      "Curves",
      {doc::reading("Measured signals, and simulations with the model of each result (by number), "
                    "over the last two periods or the whole record.")}};
  const std::vector<std::string> names = names_of_results(files.result);
  for (const auto& [condition, table] : files.curves) {
    doc::Gallery gallery;
    gallery.wide = true;
    for (Figure& figure : overlay_figures(condition, table, names))
      gallery.figures.push_back(figure_of(std::move(figure.plot)));
    if (gallery.figures.empty()) continue;
    curves.blocks.emplace_back(
        doc::Fold{condition, {std::move(gallery)}, files.curves.size() <= kFew});
  }
  // The curves are inserted before the records.
  if (curves.blocks.size() > 1) sections.insert(sections.end() - 1, std::move(curves));
  return sections;
}

std::vector<Figure> comparison_figures(const ComparisonFiles& files) {
  std::vector<Figure> figures = comparison_figures(files.result);
  for (const auto& [condition, table] : files.curves)
    for (Figure& figure : overlay_figures(condition, table, names_of_results(files.result)))
      figures.push_back({"overlay_" + figure.name, std::move(figure.plot)});
  return figures;
}

void add_comparison(const ComparisonFiles& files, Part& part) {
  for (const StoredComparedResult& result : files.result.results) {
    part.campaign += (part.campaign.empty() ? "" : ", ") + result.name;
    part.synthetic = part.synthetic || result.synthetic;
  }
}

}  // namespace rigcal::report
