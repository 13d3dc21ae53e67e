#include "report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "common/error.hpp"
#include "report/figure/pdf.hpp"
#include "report/page/assets.hpp"
#include "report/page/render.hpp"
#include "report/page/section.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

bool has_result(const ResultFolder& folder, const Section& section) {
  return std::any_of(section.files.begin(), section.files.end(),
                     [&](const std::string& file) { return folder.read(file).has_value(); });
}

/// "found neither fit.json nor ... or plan.json; expected a result folder".
std::string nothing_found() {
  std::vector<std::string> files;
  for (const Section& section : sections())
    files.insert(files.end(), section.files.begin(), section.files.end());
  std::string text = "found neither " + files.front();
  for (std::size_t i = 1; i < files.size(); ++i)
    text += (i == 1 ? " nor " : i + 1 == files.size() ? " or " : ", ") + files[i];
  return text + "; expected a result folder";
}

struct DrawnPart {
  const Section* section = nullptr;
  Part part;
};

struct Parts {
  std::vector<DrawnPart> drawn;
  Json problems = Json::array();  ///< results that are there but could not be drawn
};

/// What is there; what cannot be read is named on the page, unless it is all there is.
Parts parts_of(const ResultFolder& folder) {
  Parts parts;
  std::exception_ptr first;
  for (const Section& section : sections()) {
    if (!has_result(folder, section)) continue;
    try {
      with_json_errors(folder.where, [&] {
        parts.drawn.push_back({&section, section.part(folder)});
      });
    } catch (const InputError& error) {
      if (!first) first = std::current_exception();
      parts.problems.push_back(fmt::format("Left out: {}", error.what()));
    }
  }
  if (!parts.drawn.empty()) return parts;
  if (first) std::rethrow_exception(first);
  throw InputError({folder.where}, nothing_found());
}

/// The first part speaks for the page; the others say beside it what they found.
Json page_view(Parts parts) {
  Json view;
  const Part& first = parts.drawn.front().part;
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
  for (auto& [section, part] : parts.drawn) {
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
    view["has_" + section->name] = true;
    for (auto& [name, value] : part.view.items()) view[name] = std::move(value);
  }
  for (const auto& [id, name] : {std::pair{"provenance", "Provenance"}, {"formulas", "Formulas"}})
    view["nav"].push_back({{"id", id}, {"name", name}});
  view["bad"] = view["page_class"] == "bad";
  view["synthetic"] = synthetic;
  view["has_beside"] = !view["beside"].empty();
  view["formulas"] = formulas_view();
  view["style_html"] = std::string(asset("report.css")) + std::string(asset("uPlot.css"));
  // Its licence asks for its notice in every copy, which each page is.
  view["plot_library_html"] =
      fmt::format("/*! uPlot\n\n{}*/\n{}", asset("uPlot.LICENSE"), asset("uPlot.js"));
  view["script_html"] = std::string(asset("report.js"));
  return view;
}

}  // namespace

std::string result_page(const ReadFile& read, const std::string& where, int threads,
                        const ReadTable& made) {
  std::string lines;  // of the page's template: each section that there is
  std::vector<Partial> partials;
  for (const Section& section : sections()) {
    lines += fmt::format("{{{{#has_{0}}}}}{{{{>section_{0}}}}}{{{{/has_{0}}}}}\n", section.name);
    partials.push_back({"section_" + section.name, asset(section.name + ".html")});
  }
  partials.push_back({"sections", lines});
  return render(asset("report.html"), page_view(parts_of({read, where, threads, made})), partials);
}

std::vector<std::pair<fs::path, std::string>> result_figures(const ReadFile& read,
                                                             const std::string& where) {
  const ResultFolder folder{read, where};
  std::vector<Figure> figures;
  with_json_errors(where, [&] {
    for (const Section& section : sections()) {
      if (!has_result(folder, section)) continue;
      for (Figure& figure : section.figures(folder)) figures.push_back(std::move(figure));
    }
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
