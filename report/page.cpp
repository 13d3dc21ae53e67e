#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "report/assets.hpp"
#include "report/page_parts.hpp"
#include "report/render.hpp"
#include "report/table.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

/// All interactive series of a page together take about this many bytes.
constexpr std::size_t kSeriesBytes = 3'600'000;
constexpr double kBytesPerPoint = 2.0 * 4.0 / 3.0;
constexpr std::size_t kLeastPoints = 2000;

struct Stored {
  std::string file;  ///< fit.json or validation.json
  Json result;
  Json curves;
  std::vector<Table> series;  ///< shape (conditions)
};

Json parsed(const std::string& text, const std::string& name) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError({name}, fmt::format("this is not JSON: {}", error.what()));
  }
}

Stored load(const ReadFile& read, const std::string& where, int threads) {
  const auto path = [&](const std::string& name) { return (fs::path(where) / name).string(); };
  Stored stored;
  const auto fit = read("fit.json");
  const auto validation = read("validation.json");
  const auto curves = read("residual_tests.json");
  if (!fit && !validation) {
    throw InputError({where},
                     "found neither fit.json nor validation.json; expected the folder of a "
                     "fit or validation");
  }
  if (!curves) {
    throw InputError({path("residual_tests.json")},
                     "is missing; make the result again with this version");
  }
  stored.curves = parsed(*curves, path("residual_tests.json"));
  const bool both = fit && validation;
  const bool is_fit = both ? text_of(stored.curves, "of") == "rigcal.fit/1" : fit.has_value();
  stored.file = is_fit ? "fit.json" : "validation.json";
  stored.result = parsed(is_fit ? *fit : *validation, path(stored.file));
  const Json& conditions = stored.result.at("conditions");
  stored.series.resize(conditions.size());
  parallel_for(conditions.size(), threads, [&](std::size_t i) {
    const std::string name = "residuals/" + text_of(conditions[i], "id") + ".csv";
    if (const auto text = read(name)) stored.series[i] = parse_table(*text, path(name));
  });
  return stored;
}

/// Points of one series, so that all of them together keep the size of the page.
std::size_t points_of(const std::vector<Table>& series) {
  std::size_t columns = 0;
  for (const Table& table : series) columns += table.columns.size();
  const auto points =
      static_cast<std::size_t>(static_cast<double>(kSeriesBytes) / kBytesPerPoint /
                               static_cast<double>(std::max<std::size_t>(1, columns)));
  return std::max(points, kLeastPoints);
}

Json page_view(const Stored& stored, int threads) {
  const Json& result = stored.result;
  Json view;
  const bool is_fit = text_of(result, "schema") == "rigcal.fit/1";
  view["campaign"] = text_of(result, "campaign");
  view["kind"] = is_fit ? "Calibration" : "Validation";
  view["file"] = stored.file;
  view["synthetic"] = result.at("synthetic").get<bool>();
  view["message"] = text_of(result, "message");
  view["status"] = text_of(result, "status");
  view["headline"] = headline_view(result);
  view["matrix"] = matrix_view(result);
  view["groups"] = groups_view(result);
  view["parameters"] = parameters_view(result);
  const Json& conditions = result.at("conditions");
  const std::size_t points = points_of(stored.series);
  std::vector<Json> sections(conditions.size());
  const Json none;
  parallel_for(conditions.size(), threads, [&](std::size_t i) {
    const auto all = stored.curves.find("conditions");
    const std::string id = text_of(conditions[i], "id");
    const bool found = all != stored.curves.end() && all->contains(id);
    sections[i] =
        condition_view(result, conditions[i], stored.series[i], found ? all->at(id) : none, points);
  });
  view["has_conditions"] = !sections.empty();
  view["conditions"] = std::move(sections);
  view["identifiability"] = identifiability_view(result);
  view["starts"] = starts_view(result);
  view["ledger"] = ledger_view(result);
  view["provenance"] = provenance_view(result);
  view["formulas"] = formulas_view();
  view["style_html"] = std::string(asset("report.css")) + std::string(asset("uPlot.css"));
  view["plot_library_html"] = std::string(asset("uPlot.js"));
  view["script_html"] = std::string(asset("report.js"));
  return view;
}

/// What is JSON but no result of this version.
template <typename Work>
auto checked(const std::string& where, const Work& work) {
  try {
    return work();
  } catch (const Json::exception& error) {
    throw InputError({where},
                     fmt::format("the result is not as this version writes it: {}", error.what()));
  }
}

}  // namespace

ReadFile files_in(const fs::path& folder) {
  return [folder](const fs::path& path) -> std::optional<std::string> {
    std::ifstream stream(folder / path, std::ios::binary | std::ios::ate);
    if (!stream) return std::nullopt;
    std::string text(static_cast<std::size_t>(stream.tellg()), '\0');
    stream.seekg(0);
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream) return std::nullopt;
    return text;
  };
}

std::string result_page(const ReadFile& read, const std::string& where, int threads) {
  return checked(where, [&] {
    return render(asset("report.html"), page_view(load(read, where, threads), threads));
  });
}

std::vector<std::pair<fs::path, std::string>> result_figures(const ReadFile& read,
                                                             const std::string& where) {
  return checked(where, [&] {
    const Stored stored = load(read, where, 1);
    std::vector<std::pair<fs::path, std::string>> files;
    const std::string style(asset("figure.css"));
    for (std::size_t i = 0; i < stored.series.size(); ++i) {
      const Json& condition = stored.result.at("conditions")[i];
      for (const Figure& figure : condition_figures(condition, stored.series[i])) {
        files.emplace_back(
            fs::path("figures") / fmt::format("{}_{}.svg", text_of(condition, "id"), figure.name),
            svg(figure.plot, style) + "\n");
      }
    }
    return files;
  });
}

}  // namespace rigcal::report
