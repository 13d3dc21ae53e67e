#include "report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "datasets/campaign/condition_id.hpp"
#include "report/figure/pdf.hpp"
#include "report/page/assets.hpp"
#include "report/page/page_average.hpp"
#include "report/page/page_overlay.hpp"
#include "report/page/page_parts.hpp"
#include "report/page/page_plan.hpp"
#include "report/page/render.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

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

/// One result of the folder on the page.
struct Part {
  std::string section;  ///< key of its template: "calibration"
  std::string link;     ///< id of its first section
  std::string name;     ///< "Calibration"
  Json headline;        ///< as headline_view() makes it
  Json view;
  Json identity = {{"there", false}};  ///< as identity_view() makes it
  Json overview = {{"there", false}};  ///< as overview_view() makes it
  Json provenance;
  std::vector<std::pair<const char*, const char*>> nav;  ///< id and name of its sections
  bool synthetic = false;
  std::string campaign;
};

Part tables_fit_part(const StoredTablesFit& fit) {
  Part part;
  part.section = "calibration";
  part.link = "parameters";
  part.name = "Calibration from published tables";
  part.campaign = fit.campaign;
  part.provenance = provenance_view(fit.provenance, "Calibration", "fit.json");
  add_making(fit, part.provenance);
  part.view["parameters"] = parameters_view(fit.parameters, fit.correlation);
  part.view["has_records"] = false;
  part.headline = tables_headline(fit);
  part.nav = {{"parameters", "Parameters"}};
  return part;
}

Part calibration_part(const Calibration& stored, int threads) {
  const StoredFit& fit = stored.result;
  Part part;
  part.section = "calibration";
  part.link = "parameters";
  part.name = fit.schema == kFitSchema ? "Calibration" : "Validation";
  part.campaign = fit.campaign;
  part.identity = identity_view(fit.report);
  part.provenance = provenance_view(fit.provenance, part.name, stored.file);
  add_making(fit, part.provenance);
  part.synthetic = fit.synthetic;
  part.headline = headline_view(fit);
  part.overview = overview_view(stored);
  part.view["parameters"] = parameters_view(fit.parameters, fit.correlation);
  part.view["has_records"] = true;
  part.view["unfinished"] = fit.status == calib::FitStatus::stopped && !searched_to_the_end(fit);
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

Part fit_part(const ReadFile& read, const std::string& where, int threads, const ReadTable& made) {
  const auto stored = load_calibration(read, where, threads, made);
  if (const auto* tables = std::get_if<StoredTablesFit>(&stored)) return tables_fit_part(*tables);
  return calibration_part(std::get<Calibration>(stored), threads);
}

Part leak_table_part(const ReadFile& read, const std::string& where) {
  const LeakTableFiles stored = load_leak_table(read, where);
  Part part;
  part.section = part.link = "leak-table";
  part.name = "Leak table";
  part.campaign = stored.result.campaign;
  part.headline = leak_table_headline(stored);
  part.view["leak_table"] = leak_table_view(stored);
  part.provenance = provenance_view(stored.result.provenance, part.name, "leak_table.json");
  part.nav = {{"leak-table", "Leak table"}};
  return part;
}

Part diagnosis_part(const ReadFile& read, const std::string& where) {
  const StoredDiagnosis diagnosis = load_diagnosis(read, where);
  Part part;
  part.section = part.link = "diagnosis";
  part.name = "Diagnosis";
  part.campaign = diagnosis.campaign;
  part.synthetic = diagnosis.synthetic;
  part.identity = identity_view(diagnosis.report);
  part.headline = diagnosis_headline(diagnosis);
  part.view["diagnosis"] = diagnosis_view(diagnosis);
  part.provenance = provenance_view(diagnosis.provenance, part.name, "diagnosis.json");
  part.nav = {{"diagnosis", "Diagnosis"}};
  return part;
}

Part parity_part(const ReadFile& read, const std::string& where) {
  const ParityFiles stored = load_parity(read, where);
  Part part;
  part.section = part.link = "parity";
  part.name = "Parity residual";
  part.campaign = stored.result.campaign;
  part.synthetic = stored.result.synthetic;
  part.identity = identity_view(stored.result.report);
  part.headline = parity_headline(stored);
  part.view["parity"] = parity_view(stored);
  part.provenance = provenance_view(stored.result.provenance, part.name, "parity.json");
  part.nav = {{"parity", "Parity residual"}};
  return part;
}

/// The overlaid curves of a comparison, by condition in the order of its scores.
std::vector<std::pair<std::string, Table>> curves_of(const ReadFile& read, const std::string& where,
                                                     const StoredComparison& comparison) {
  const ReadFile own = files_of_run(read, comparison.provenance, where, "comparison.json");
  std::vector<std::pair<std::string, Table>> curves;
  for (const StoredComparedCondition& condition : comparison.conditions) {
    const std::string& id = condition.id;
    const auto same = [&](const auto& each) { return each.first == id; };
    if (!datasets::is_condition_id(id) || std::any_of(curves.begin(), curves.end(), same)) continue;
    const std::string name = "overlay/" + id + ".csv";
    if (const auto text = own(name))
      curves.emplace_back(id, parse_table(*text, (fs::path(where) / name).string()));
  }
  return curves;
}

std::vector<std::string> names_of_results(const StoredComparison& comparison) {
  std::vector<std::string> names;
  for (const StoredComparedResult& result : comparison.results) names.push_back(result.name);
  return names;
}

Part comparison_part(const ReadFile& read, const std::string& where) {
  const StoredComparison comparison = load_comparison(read, where);
  Part part;
  part.section = "comparison";
  part.link = "results";
  part.name = "Comparison";
  for (const StoredComparedResult& result : comparison.results) {
    part.campaign += (part.campaign.empty() ? "" : ", ") + result.name;
    part.synthetic = part.synthetic || result.synthetic;
  }
  part.headline = comparison_headline(comparison);
  part.view["comparison"] = comparison_view(comparison);
  Json& overlays = part.view["comparison"]["overlays"] =
      overlays_view(curves_of(read, where, comparison), names_of_results(comparison));
  const bool has_overlays = !overlays.empty();
  part.view["comparison"]["has_overlays"] = has_overlays;
  part.provenance = provenance_view(comparison.provenance, part.name, "comparison.json");
  part.nav = {{"results", "Results"}, {"estimates", "Parameters"}, {"models", "Models"}};
  if (part.view["comparison"].at("has_trends").get<bool>()) part.nav.push_back({"trends", "Trend"});
  if (part.view["comparison"].at("has_conditions").get<bool>())
    part.nav.push_back({"scores", "Scores"});
  if (has_overlays) part.nav.push_back({"curves", "Curves"});
  part.nav.push_back({"records", "Records"});
  return part;
}

Part batch_part(const ReadFile& read, const std::string& where) {
  const auto batch = load<StoredBatch>(read, where, "batch.json");
  Part part;
  part.section = "batch";
  part.link = "rigs";
  part.name = "Batch";
  part.campaign = batch.folder;
  for (const StoredRig& rig : batch.rigs) part.synthetic = part.synthetic || rig.synthetic;
  part.headline = batch_headline(batch);
  part.view["batch"] = batch_view(batch);
  part.provenance = provenance_view(batch.provenance, part.name, "batch.json");
  part.nav = {{"rigs", "Rigs"}, {"rig-trends", "Trends"}};
  return part;
}

Part average_part(const ReadFile& read, const std::string& where) {
  const AverageFiles stored = load_average(read, where);
  Part part;
  part.section = "average";
  part.link = "repeatability";
  part.name = "Repeatability";
  part.campaign = stored.result.campaign;
  part.synthetic = stored.result.synthetic;
  part.headline = average_headline(stored);
  part.view["average"] = average_view(stored);
  part.provenance = provenance_view(stored.result.provenance, part.name, "average.json");
  part.nav = {{"repeatability", "Repeatability"}, {"means", "Means"}};
  return part;
}

Part plan_part(const ReadFile& read, const std::string& where) {
  const StoredPlan plan = load_plan(read, where);
  Part part;
  part.section = part.link = "plan";
  part.name = "Plan";
  part.campaign = plan.campaign;
  part.headline = plan_headline(plan);
  part.view["plan"] = plan_view(plan);
  part.provenance = provenance_view(plan.provenance, part.name, "plan.json");
  part.nav = {{"plan", "Plan"}};
  return part;
}

struct Parts {
  std::vector<Part> drawn;
  Json problems = Json::array();  ///< results that are there but could not be drawn
};

/// What is there; what cannot be read is named on the page, unless it is all there is.
Parts parts_of(const ReadFile& read, const std::string& where, int threads, const ReadTable& made) {
  Parts parts;
  std::exception_ptr first;
  const auto add = [&](bool is_there, const auto& make) {
    if (!is_there) return;
    try {
      with_json_errors(where, [&] { parts.drawn.push_back(make()); });
    } catch (const InputError& error) {
      if (!first) first = std::current_exception();
      parts.problems.push_back(fmt::format("Left out: {}", error.what()));
    }
  };
  const auto has = [&](const char* file) { return read(file).has_value(); };
  add(has("fit.json") || has("validation.json"),
      [&] { return fit_part(read, where, threads, made); });
  add(has("leak_table.json"), [&] { return leak_table_part(read, where); });
  add(has("diagnosis.json"), [&] { return diagnosis_part(read, where); });
  add(has("parity.json"), [&] { return parity_part(read, where); });
  add(has("comparison.json"), [&] { return comparison_part(read, where); });
  add(has("batch.json"), [&] { return batch_part(read, where); });
  add(has("average.json"), [&] { return average_part(read, where); });
  add(has("plan.json"), [&] { return plan_part(read, where); });
  if (!parts.drawn.empty()) return parts;
  if (first) std::rethrow_exception(first);
  throw InputError(
      {where},
      "found neither fit.json nor validation.json, leak_table.json, diagnosis.json, "
      "parity.json, comparison.json, batch.json, average.json or plan.json; expected a result "
      "folder");
}

/// The first part speaks for the page; the others say beside it what they found.
Json page_view(Parts parts) {
  Json view;
  Part& first = parts.drawn.front();
  view["kind"] = first.name;
  view["campaign"] = first.campaign;
  view["identity"] = first.identity;
  view["overview"] = first.overview;
  view["headline"] = first.headline;
  view["page_class"] = first.headline.at("class");
  view["problems"] = std::move(parts.problems);
  view["beside"] = Json::array();
  view["nav"] = Json::array();
  view["provenance"] = Json::array();
  bool synthetic = false;
  for (Part& part : parts.drawn) {
    synthetic = synthetic || part.synthetic;
    if (&part != &first) {
      view["beside"].push_back({{"link", part.link},
                                {"name", part.name},
                                {"text", part.headline.at("sentence")},
                                {"word", part.headline.at("word")},
                                {"class", part.headline.at("class")}});
      // What cannot be used marks the page, wherever it stands.
      if (part.headline.at("class") == "bad") view["page_class"] = "bad";
    }
    for (const auto& [id, name] : part.nav) view["nav"].push_back({{"id", id}, {"name", name}});
    view["provenance"].push_back(std::move(part.provenance));
    std::string key = part.section;
    std::replace(key.begin(), key.end(), '-', '_');
    view["has_" + key] = true;
    for (auto& [name, value] : part.view.items()) view[name] = std::move(value);
  }
  for (const auto& [id, name] : {std::pair{"provenance", "Provenance"}, {"formulas", "Formulas"}})
    view["nav"].push_back({{"id", id}, {"name", name}});
  view["bad"] = view["page_class"] == "bad";
  view["synthetic"] = synthetic;
  view["has_beside"] = !view["beside"].empty();
  view["formulas"] = formulas_view();
  view["style_html"] = std::string(asset("report.css")) + std::string(asset("uPlot.css"));
  view["plot_library_html"] = std::string(asset("uPlot.js"));
  view["script_html"] = std::string(asset("report.js"));
  return view;
}

}  // namespace

std::string result_page(const ReadFile& read, const std::string& where, int threads,
                        const ReadTable& made) {
  std::vector<Partial> sections;
  for (const std::string name : {"calibration", "leak_table", "diagnosis", "parity", "comparison",
                                 "batch", "average", "plan"})
    sections.push_back({"section_" + name, asset(name + ".html")});
  return render(asset("report.html"), page_view(parts_of(read, where, threads, made)), sections);
}

std::vector<std::pair<fs::path, std::string>> result_figures(const ReadFile& read,
                                                             const std::string& where) {
  std::vector<Figure> figures;
  const auto add = [&](std::vector<Figure> more, const std::string& prefix = {}) {
    for (Figure& figure : more) figures.push_back({prefix + figure.name, std::move(figure.plot)});
  };
  const auto has = [&](const char* file) { return read(file).has_value(); };
  with_json_errors(where, [&] {
    if (has("fit.json") || has("validation.json")) {
      const auto stored = load_calibration(read, where, 1);
      if (const auto* fit = std::get_if<Calibration>(&stored)) {
        for (std::size_t i = 0; i < fit->result.conditions.size(); ++i) {
          const StoredCondition& condition = fit->result.conditions[i];
          add(condition_figures(condition, *fit->series(i)), condition.id + "_");
        }
      }
    }
    if (has("leak_table.json")) add(leak_table_figures(load_leak_table(read, where)));
    if (has("diagnosis.json")) add(diagnosis_figures(load_diagnosis(read, where)));
    if (has("parity.json")) add(parity_figures(load_parity(read, where)));
    if (has("comparison.json")) {
      const StoredComparison comparison = load_comparison(read, where);
      add(comparison_figures(comparison));
      for (const auto& [condition, table] : curves_of(read, where, comparison))
        add(overlay_figures(condition, table, names_of_results(comparison)), "overlay_");
    }
    if (has("average.json")) add(average_figures(load_average(read, where)));
    if (has("plan.json")) add(plan_figures(load_plan(read, where)));
    if (has("batch.json")) add(batch_figures(load<StoredBatch>(read, where, "batch.json")));
  });
  std::vector<std::pair<fs::path, std::string>> files;
  const std::string style(asset("figure.css"));
  for (const Figure& figure : figures) {
    files.emplace_back(fs::path("figures") / (figure.name + ".svg"),
                       svg(figure.plot, style) + "\n");
    files.emplace_back(fs::path("figures") / (figure.name + ".pdf"), pdf(figure.plot));
  }
  return files;
}

}  // namespace rigcal::report
