#include "report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "report/figure/pdf.hpp"
#include "report/page/assets.hpp"
#include "report/page/page_parts.hpp"
#include "report/page/render.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

/// All interactive series of a page together take about this many bytes.
constexpr std::size_t kSeriesBytes = 3'600'000;
constexpr double kBytesPerPoint = 2.0 * 4.0 / 3.0;
constexpr std::size_t kLeastPoints = 2000;

/// Points of one series, so that all of them together keep the size of the page.
std::size_t points_of(const Calibration& stored, std::size_t conditions) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < conditions; ++i) columns += stored.series(i)->columns.size();
  const auto points =
      static_cast<std::size_t>(static_cast<double>(kSeriesBytes) / kBytesPerPoint /
                               static_cast<double>(std::max<std::size_t>(1, columns)));
  return std::max(points, kLeastPoints);
}

Json condition_views(const Calibration& stored, int threads) {
  const Json& conditions = stored.result.at("conditions");
  const std::size_t points = points_of(stored, conditions.size());
  std::vector<Json> sections(conditions.size());
  const Json none;
  const auto all = stored.curves.find("conditions");
  parallel_for(conditions.size(), threads, [&](std::size_t i) {
    const std::string id = text_of(conditions.at(i), "id");
    const bool found = all != stored.curves.end() && all->contains(id);
    sections[i] =
        condition_view(conditions.at(i), *stored.series(i), found ? all->at(id) : none, points);
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

StoredProvenance provenance_of(const Json& result, const std::string& file) {
  StoredProvenance provenance;
  read_into(JsonNode(result, file, "", file)["provenance"], provenance);
  return provenance;
}

Part calibration_part(const ReadFile& read, const std::string& where, int threads,
                      const ReadTable& made) {
  const Calibration stored = load_calibration(read, where, threads, made);
  const Json& result = stored.result;
  const bool is_fit = text_of(result, "schema") == "rigcal.fit/1";
  Part part;
  part.section = "calibration";
  part.link = "parameters";
  part.name = is_fit ? "Calibration" : "Validation";
  part.campaign = text_of(result, "campaign");
  part.identity = identity_view(result);
  part.provenance = provenance_view(provenance_of(result, stored.file), part.name, stored.file);
  add_making(result, part.provenance);
  part.view["parameters"] = parameters_view(result);
  part.view["has_records"] = !stored.of_tables;
  if (stored.of_tables) {
    part.name = "Calibration from published tables";
    part.headline = tables_headline(result);
    part.nav = {{"parameters", "Parameters"}};
    return part;
  }
  part.synthetic = result.at("synthetic").get<bool>();
  part.headline = headline_view(result);
  part.overview = overview_view(stored);
  const std::string stopped_in = text_of(result, "stopped_in");
  part.view["unfinished"] =
      text_of(result, "status") == "stopped" && (stopped_in.empty() || stopped_in == "starts");
  part.view["matrix"] = matrix_view(result);
  part.view["has_matrix"] = !part.view["matrix"].empty();
  part.view["groups"] = groups_view(result);
  part.view["has_conditions"] = !result.at("conditions").empty();
  part.view["conditions"] = condition_views(stored, threads);
  part.view["identifiability"] = identifiability_view(result);
  part.view["trust"] = trust_view(result);
  part.view["starts"] = starts_view(result);
  part.view["ledger"] = ledger_view(result);
  part.nav = {{"matrix", "Scores"},         {"parameters", "Parameters"},
              {"conditions", "Conditions"}, {"identifiability", "Identifiability"},
              {"starts", "Starts"},         {"warnings", "Warnings"}};
  return part;
}

Part leak_table_part(const ReadFile& read, const std::string& where) {
  const LeakTableFiles stored = load_leak_table(read, where);
  Part part;
  part.section = part.link = "leak-table";
  part.name = "Leak table";
  part.campaign = stored.table.campaign;
  part.headline = leak_table_headline(stored.table);
  part.view["leak_table"] = leak_table_view(stored);
  part.provenance = provenance_view(stored.table.provenance, part.name, "leak_table.json");
  part.nav = {{"leak-table", "Leak table"}};
  return part;
}

Part diagnosis_part(const ReadFile& read, const std::string& where) {
  const Json diagnosis = load_json(read, where, "diagnosis.json");
  Part part;
  part.section = part.link = "diagnosis";
  part.name = "Diagnosis";
  part.campaign = text_of(diagnosis, "campaign");
  part.synthetic = diagnosis.at("synthetic").get<bool>();
  part.identity = identity_view(diagnosis);
  part.headline = diagnosis_headline(diagnosis);
  part.view["diagnosis"] = diagnosis_view(diagnosis);
  part.provenance =
      provenance_view(provenance_of(diagnosis, "diagnosis.json"), part.name, "diagnosis.json");
  part.nav = {{"diagnosis", "Diagnosis"}};
  return part;
}

Part parity_part(const ReadFile& read, const std::string& where) {
  const ParityFiles stored = load_parity(read, where);
  Part part;
  part.section = part.link = "parity";
  part.name = "Parity residual";
  part.campaign = text_of(stored.parity, "campaign");
  part.synthetic = stored.parity.at("synthetic").get<bool>();
  part.identity = identity_view(stored.parity);
  part.headline = parity_headline(stored.parity);
  part.view["parity"] = parity_view(stored);
  part.provenance =
      provenance_view(provenance_of(stored.parity, "parity.json"), part.name, "parity.json");
  part.nav = {{"parity", "Parity residual"}};
  return part;
}

Part comparison_part(const ReadFile& read, const std::string& where) {
  const Json comparison = load_json(read, where, "comparison.json");
  Part part;
  part.section = "comparison";
  part.link = "results";
  part.name = "Comparison";
  for (const Json& result : comparison.at("results")) {
    part.campaign += (part.campaign.empty() ? "" : ", ") + text_of(result, "name");
    part.synthetic = part.synthetic || result.at("synthetic") == true;
  }
  part.headline = comparison_headline(comparison);
  part.view["comparison"] = comparison_view(comparison);
  part.provenance =
      provenance_view(provenance_of(comparison, "comparison.json"), part.name, "comparison.json");
  part.nav = {{"results", "Results"}, {"estimates", "Parameters"}, {"models", "Models"}};
  if (part.view["comparison"].at("has_trends").get<bool>()) part.nav.push_back({"trends", "Trend"});
  if (part.view["comparison"].at("has_conditions").get<bool>())
    part.nav.push_back({"scores", "Scores"});
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
      [&] { return calibration_part(read, where, threads, made); });
  add(has("leak_table.json"), [&] { return leak_table_part(read, where); });
  add(has("diagnosis.json"), [&] { return diagnosis_part(read, where); });
  add(has("parity.json"), [&] { return parity_part(read, where); });
  add(has("comparison.json"), [&] { return comparison_part(read, where); });
  add(has("batch.json"), [&] { return batch_part(read, where); });
  if (!parts.drawn.empty()) return parts;
  if (first) std::rethrow_exception(first);
  throw InputError({where},
                   "found neither fit.json nor validation.json, leak_table.json, diagnosis.json, "
                   "parity.json, comparison.json or batch.json; expected a result folder");
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
  for (const std::string name :
       {"calibration", "leak_table", "diagnosis", "parity", "comparison", "batch"})
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
      const Calibration stored = load_calibration(read, where, 1);
      const Json& conditions = stored.result.at("conditions");
      for (std::size_t i = 0; !stored.of_tables && i < conditions.size(); ++i) {
        const Json& condition = conditions.at(i);
        add(condition_figures(condition, *stored.series(i)), text_of(condition, "id") + "_");
      }
    }
    if (has("leak_table.json")) add(leak_table_figures(load_leak_table(read, where)));
    if (has("diagnosis.json")) add(diagnosis_figures(load_json(read, where, "diagnosis.json")));
    if (has("parity.json")) add(parity_figures(load_parity(read, where)));
    if (has("comparison.json")) add(comparison_figures(load_json(read, where, "comparison.json")));
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
