#include "report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <set>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/document/assets.hpp"
#include "report/document/render_html.hpp"
#include "report/figure/pdf.hpp"
#include "report/page/section.hpp"
#include "report/text/escape.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

bool has_result(const ResultFolder& folder, const Section& section) {
  return std::any_of(section.files.begin(), section.files.end(),
                     [&](const std::string& file) { return folder.read(file) != nullptr; });
}

/// Returns, for example, "found neither fit.json nor ... or plan.json; expected a result folder".
std::string nothing_found() {
  std::vector<std::string> files;
  for (const Section& section : sections())
    files.insert(files.end(), section.files.begin(), section.files.end());
  std::string text = "found neither " + files.front();
  for (std::size_t i = 1; i < files.size(); ++i)
    text += (i == 1 ? " nor " : i + 1 == files.size() ? " or " : ", ") + files[i];
  return text + "; expected a result folder";
}

struct Parts {
  std::vector<Part> drawn;
  std::vector<std::string> problems;  ///< results that exist but could not be drawn
};

/// Reads the results in a folder. Unreadable results are named on the page. If all of them are
/// unreadable, the first error is thrown.
Parts parts_of(const ResultFolder& folder) {
  Parts parts;
  std::exception_ptr first;
  for (const Section& section : sections()) {
    if (!has_result(folder, section)) continue;
    try {
      with_json_errors(folder.where, [&] { parts.drawn.push_back(section.part(folder)); });
    } catch (const InputError& error) {
      if (!first) first = std::current_exception();
      parts.problems.push_back(fmt::format("Left out: {}", error.what()));
    }
  }
  if (!parts.drawn.empty()) return parts;
  if (first) std::rethrow_exception(first);
  throw InputError({folder.where}, nothing_found());
}

/// Quotes a text as a style-sheet string and escapes everything in it.
std::string css_string(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= 0x80 || c == ' ' || c == '.' || c == '-' || c == ',' ||
                       (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    result += plain ? std::string(1, c) : fmt::format("\\{:x} ", byte);
  }
  return result + "\"";
}

/// Returns the style for the footer of printed pages: laboratory, report and source file.
std::string foot_style(const Part& first, bool bad, const std::string& sha256) {
  std::string left;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) left += (left.empty() ? "" : " · ") + text;
  };
  add(first.identity.number);
  add(first.identity.rig.empty() ? first.campaign : first.identity.rig);
  add(first.verdict.badge.words);
  if (!first.identity.issued.empty()) add("issued " + first.identity.issued);
  if (!first.identity.number.empty()) add("relates only to the items tested");
  const std::string right =
      css_string(fmt::format("SHA-256 of {} {} · page ", first.file, sha256.substr(0, 8)));
  return fmt::format(
      "@page {{ @bottom-left {{ content: {}; width: 62%; font-size: 7pt; color: {}; }} "
      "@bottom-right {{ content: {} counter(page) \" of \" counter(pages); font-size: 7pt; color: "
      "#444; }} }}",
      css_string(left), bad ? "#8f1607; font-weight: bold" : "#444", right);
}

/// Adds the title, the laboratory and the report number.
void add_top(const Part& first, bool synthetic, std::string& page) {
  const Identity& identity = first.identity;
  page += "<header class=\"top\"><div>\n<h1 id=\"title\">" + escaped(first.name) +
          (first.campaign.empty() ? "" : " of " + escaped(first.campaign)) + "</h1>\n";
  std::string whose = escaped(identity.laboratory);
  if (!identity.customer.empty())
    whose += (whose.empty() ? "for " : " · for ") + escaped(identity.customer);
  if (!whose.empty()) page += "<p>" + whose + "</p>\n";
  if (synthetic) page += "<p><strong>synthetic records</strong></p>\n";
  page += "</div>\n";
  if (!identity.number.empty() || !identity.issued.empty()) {
    page += "<p class=\"issue\">";
    if (!identity.number.empty())
      page += "Report number <strong>" + escaped(identity.number) + "</strong>";
    if (!identity.replaces.empty()) page += "<br>replaces " + escaped(identity.replaces);
    if (!identity.issued.empty())
      page +=
          std::string(identity.number.empty() ? "" : "<br>") + "issued " + escaped(identity.issued);
    page += "</p>\n";
  }
  page += "</header>\n";
}

/// Lists every file that any result on the page was made from, without duplicates.
doc::Fold inputs_of(const Parts& parts) {
  doc::Table inputs{"Input files"};
  inputs.style = "hashes";
  inputs.file = parts.drawn.front().file;
  inputs.columns = {{"File"}, {"SHA-256"}};
  std::set<std::pair<std::string, std::string>> listed;
  for (const Part& part : parts.drawn)
    for (const InputFile& input : part.inputs)
      if (listed.emplace(input.path, input.sha256).second)
        inputs.rows.push_back({{input.path, input.sha256}});
  return {fmt::format("{} input file{} with SHA-256", listed.size(), listed.size() == 1 ? "" : "s"),
          {std::move(inputs)}};
}

/// Adds the page to be signed: the verdict of the first result with its evidence, then the verdicts
/// of the others.
void add_first_page(const Parts& parts, bool synthetic, const std::string& sha256,
                    std::string& page) {
  const Part& first = parts.drawn.front();
  page += "<section id=\"verdict\" aria-labelledby=\"title\">\n";
  add_top(first, synthetic, page);
  doc::Blocks blocks{first.verdict};
  for (const std::string& problem : parts.problems)
    blocks.emplace_back(doc::Paragraph{{problem}, doc::Paragraph::Tone::problem});
  doc::List beside;
  for (std::size_t i = 1; i < parts.drawn.size(); ++i) {
    const Part& part = parts.drawn[i];
    doc::Line line{part.verdict.badge, " ", doc::Link{"#" + part.link, part.name}, ": "};
    line.insert(line.end(), part.verdict.sentence.begin(), part.verdict.sentence.end());
    beside.items.push_back(std::move(line));
  }
  blocks.emplace_back(std::move(beside));
  doc::render_html(blocks, page);
  doc::render_html(first.front, page);
  doc::Facts facts = first.identity.facts;
  if (!facts.rows.empty() || !first.front.empty()) {
    facts.shape = doc::Facts::Shape::grid;
    facts.rows.push_back({"Software", {first.program}});
    facts.rows.push_back(
        {"Result", {fmt::format("{}, SHA-256 {}…", first.file, sha256.substr(0, 16))}});
    doc::render_html({doc::Heading{{"Item and method"}, 2}, std::move(facts)}, page);
  }
  doc::render_html({first.identity.signatures}, page);
  page += "</section>\n\n";
}

/// Removes the blocks that make a page long, and all but the first few pictures of a section.
void shorten(doc::Blocks& blocks) {
  constexpr std::size_t kMostPictures = 4;
  std::size_t pictures = 0;
  for (doc::Block& block : blocks) {
    if (auto* table = std::get_if<doc::Table>(&block)) {
      for (doc::Row& row : table->rows)
        for (doc::Cell& cell : row.cells)
          for (doc::Tile& tile : cell.tiles) tile.picture.reset();
    }
  }
  std::erase_if(blocks, [&](const doc::Block& block) {
    if (const auto* gallery = std::get_if<doc::Gallery>(&block)) {
      pictures += gallery->figures.size();
      return pictures > kMostPictures;
    }
    if (std::holds_alternative<doc::Figure>(block)) return ++pictures > kMostPictures;
    return std::holds_alternative<doc::Fold>(block) ||
           std::holds_alternative<doc::Article>(block) ||
           std::holds_alternative<doc::Rendered>(block) ||
           std::holds_alternative<doc::LivePlot>(block) ||
           std::holds_alternative<doc::LiveSeries>(block);
  });
}

void shorten(Parts& parts) {
  for (Part& part : parts.drawn) {
    shorten(part.front);
    for (doc::Section& section : part.sections) shorten(section.blocks);
    std::erase_if(part.sections,
                  [](const doc::Section& section) { return section.blocks.empty(); });
  }
}

enum class PageExtent { whole, brief };

std::string page_of(const Parts& parts, const ReadFile& read, PageExtent extent) {
  const Part& first = parts.drawn.front();
  const std::string sha256 = sha256_of(*read(first.file));
  // One unusable result marks the whole page.
  const bool bad = std::any_of(parts.drawn.begin(), parts.drawn.end(), [](const Part& part) {
    return part.verdict.badge.state == doc::State::bad;
  });
  const bool synthetic = std::any_of(parts.drawn.begin(), parts.drawn.end(),
                                     [](const Part& part) { return part.synthetic; });
  const doc::Badge& badge = first.verdict.badge;
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
      "name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'{}; img-src data: blob:\">\n<meta "
      "name=\"color-scheme\" content=\"light dark\">\n<title>{} – {} – {}</title>\n",
      first.live && extent == PageExtent::whole ? " 'wasm-unsafe-eval'; worker-src blob:" : "",
      escaped(badge.words), escaped(first.campaign), escaped(first.name));
  page += fmt::format("<style>{}{}{}</style>\n</head>\n", asset("report.css"), asset("uPlot.css"),
                      foot_style(first, bad, sha256));
  if (extent == PageExtent::brief) {
    page += fmt::format("<body class=\"{}\">\n<main>\n", bad ? "bad" : doc::css(badge.state));
    add_first_page(parts, synthetic, sha256, page);
    for (const Part& part : parts.drawn)
      for (const doc::Section& section : part.sections) doc::render_html(section, page);
    return page + "</main>\n</body>\n</html>\n";
  }
  page += fmt::format(
      "<body class=\"{}\">\n<a class=\"skip\" href=\"#verdict\">Skip to the verdict</a>\n<header "
      "class=\"bar\">\n<span class=\"badge {}\"><span aria-hidden=\"true\">{}</span> "
      "{}</span>\n<strong class=\"name\">{}</strong>\n<nav aria-label=\"Sections\">\n",
      bad ? "bad" : doc::css(badge.state), doc::css(badge.state), doc::mark(badge.state),
      escaped(badge.words), escaped(first.campaign));
  const auto add_link = [&](const std::string& id, const std::string& name) {
    page += fmt::format("<a href=\"#{}\">{}</a>", escaped(id), escaped(name));
  };
  if (first.live) add_link("try", "Try it");
  for (const Part& part : parts.drawn)
    for (const auto& [id, name] : part.nav) add_link(id, name);
  add_link("provenance", "Provenance");
  add_link("formulas", "Formulas");
  page += "\n</nav>\n</header>\n<main>\n";
  add_first_page(parts, synthetic, sha256, page);
  if (first.live) page += first.live->html;
  doc::Section provenance{
      "provenance",
      "Provenance",
      {doc::reading("The same inputs and these commands reproduce the same numbers.")}};
  for (const Part& part : parts.drawn) {
    for (const doc::Section& section : part.sections) doc::render_html(section, page);
    provenance.blocks.insert(provenance.blocks.end(), part.provenance.begin(),
                             part.provenance.end());
  }
  provenance.blocks.emplace_back(inputs_of(parts));
  doc::render_html(provenance, page);
  doc::render_html(formulas_section(), page);
  // The licence of the plot library requires its notice in every copy, and each page contains one.
  page += fmt::format("</main>\n<script>/*! uPlot\n\n{}*/\n{}</script>\n<script>{}</script>\n",
                      asset("uPlot.LICENSE"), asset("uPlot.js"), asset("report.js"));
  if (first.live) page += first.live->scripts;
  return page + "</body>\n</html>\n";
}

std::vector<doc::Document> documents_of(Parts parts) {
  return {std::make_move_iterator(parts.drawn.begin()), std::make_move_iterator(parts.drawn.end())};
}

}  // namespace

std::string result_page(const ReadFile& read, const std::string& where, int threads) {
  return page_of(parts_of({read, where, threads}), read, PageExtent::whole);
}

std::vector<doc::Document> add_page(const fs::path& out, int threads,
                                    std::vector<ResultFile>& files, const ReadFile& made) {
  const ReadFile own = files_in(files);
  const ReadFile read = either(made ? either(own, made) : own, files_in(out));
  Parts parts = parts_of({read, out.string(), threads});
  std::string page = page_of(parts, read, PageExtent::whole);
  std::erase_if(parts.drawn, [&](const Part& part) { return !own(part.file); });
  files.insert(files.end() - 1, {"report.html", std::move(page)});
  return documents_of(std::move(parts));
}

std::vector<doc::Document> result_documents(const ReadFile& read, const std::string& where) {
  return documents_of(parts_of({read, where, 1, false}));
}

std::string brief_page(const ReadFile& read, const std::string& where) {
  Parts parts = parts_of({read, where, 1, false});
  shorten(parts);
  return page_of(parts, read, PageExtent::brief);
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
