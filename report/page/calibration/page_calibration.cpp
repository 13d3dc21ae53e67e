#include "report/page/calibration/page_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/parallel.hpp"

namespace rigcal::report {
namespace {

/// All interactive series of a page together take about this many bytes.
constexpr std::size_t kSeriesBytes = 3'600'000;
constexpr double kBytesPerPoint = 2.0 * 4.0 / 3.0;
constexpr std::size_t kLeastPoints = 2000;

/// Points of one series, so that all of them together keep the size of the page.
std::size_t points_of(const Calibration& stored) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < stored.result.conditions.size(); ++i)
    columns += stored.series(i)->columns.size();
  const auto points =
      static_cast<std::size_t>(static_cast<double>(kSeriesBytes) / kBytesPerPoint /
                               static_cast<double>(std::max<std::size_t>(1, columns)));
  return std::max(points, kLeastPoints);
}

Json condition_views(const Calibration& stored, int threads) {
  const std::vector<StoredCondition>& conditions = stored.result.conditions;
  const std::size_t points = points_of(stored);
  std::vector<Json> sections(conditions.size());
  parallel_for(conditions.size(), threads, [&](std::size_t i) {
    sections[i] = condition_view(conditions[i], *stored.series(i),
                                 find(stored.curves.conditions, conditions[i].id), points);
    sections[i]["open"] = i == 0 || conditions.size() <= kFew;
  });
  return sections;
}

Part tables_fit_part(const StoredTablesFit& fit) {
  Part part;
  part.link = "parameters";
  part.name = "Calibration from published tables";
  part.campaign = fit.campaign;
  part.provenance = provenance_view(fit.provenance, "Calibration", "fit.json");
  add_making(fit, part.provenance);
  part.view["parameters"] =
      parameters_view(fit.parameters, fit.correlation, fit.status != calib::FitStatus::stopped);
  part.view["has_records"] = false;
  part.headline = tables_headline(fit);
  part.nav = {{"parameters", "Parameters"}};
  return part;
}

Part fit_part(const Calibration& stored, int threads) {
  const StoredFit& fit = stored.result;
  Part part;
  part.link = "parameters";
  part.name = is_fit_schema(fit.schema) ? "Calibration" : "Validation";
  part.campaign = fit.campaign;
  part.identity = identity_view(fit.report);
  part.provenance = provenance_view(fit.provenance, part.name, stored.file);
  add_making(fit, part.provenance);
  part.synthetic = fit.synthetic;
  part.headline = headline_view(fit);
  part.overview = overview_view(stored);
  const bool unfinished = fit.status == calib::FitStatus::stopped && !searched_to_the_end(fit);
  part.view["parameters"] = parameters_view(fit.parameters, fit.correlation, !unfinished);
  part.view["has_records"] = true;
  part.view["unfinished"] = unfinished;
  part.view["matrix"] = matrix_view(fit);
  part.view["has_matrix"] = !part.view["matrix"].empty();
  part.view["groups"] = groups_view(fit);
  part.view["group_count"] = fmt::format("{}", part.view["groups"].size());
  part.view["has_conditions"] = !fit.conditions.empty();
  part.view["conditions"] = condition_views(stored, threads);
  part.view["identifiability"] = identifiability_view(fit);
  part.view["trust"] = trust_view(fit);
  part.view["starts"] = starts_view(fit);
  part.view["ledger"] = ledger_view(fit);
  part.nav = {{"matrix", "Scores"},         {"parameters", "Parameters"},
              {"conditions", "Conditions"}, {"identifiability", "Identifiability"},
              {"starts", "Starts"},         {"warnings", "Warnings"}};
  return part;
}

}  // namespace

Part calibration_part(const ResultFolder& folder) {
  const auto stored = load_calibration(folder.read, folder.where, folder.threads, folder.made);
  if (const auto* tables = std::get_if<StoredTablesFit>(&stored)) return tables_fit_part(*tables);
  return fit_part(std::get<Calibration>(stored), folder.threads);
}

std::vector<Figure> calibration_figures(const ResultFolder& folder) {
  const auto stored = load_calibration(folder.read, folder.where, folder.threads, folder.made);
  std::vector<Figure> figures;
  const auto* fit = std::get_if<Calibration>(&stored);
  if (fit == nullptr) return figures;
  for (std::size_t i = 0; i < fit->result.conditions.size(); ++i) {
    const StoredCondition& condition = fit->result.conditions[i];
    for (Figure& figure : condition_figures(condition, *fit->series(i)))
      figures.push_back({condition.id + "_" + figure.name, std::move(figure.plot)});
  }
  return figures;
}

}  // namespace rigcal::report
