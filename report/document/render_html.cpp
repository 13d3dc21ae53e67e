#include "report/document/render_html.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <new>
#include <vector>

#include "report/document/overloaded.hpp"
#include "report/figure/decimate.hpp"
#include "report/text/escape.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report::doc {
namespace {

/// Compresses text as a zlib stream, which browsers can unpack.
std::vector<std::uint8_t> deflated(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(text.data()), text.size(),
                Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

std::string marked(const Badge& badge) {
  return fmt::format("<span aria-hidden=\"true\">{}</span> {}", mark(badge.state),
                     escaped(badge.words));
}

std::string tag(const Badge& badge) {
  return fmt::format("<span class=\"tag {}\">{}</span>", css(badge.state), marked(badge));
}

std::string html_of(const Quantity& quantity) {
  const std::string unit = quantity.unit.empty() ? "" : " " + escaped(quantity.unit);
  if (!quantity.exact) return escaped(quantity.text) + unit;
  return fmt::format("<data value=\"{}\">{}</data>{}", *quantity.exact, escaped(quantity.text),
                     unit);
}

std::string html_of(const Inline& part) {
  return std::visit(
      Overloaded{
          [](const std::string& text) { return escaped(text); },
          [](const Quantity& quantity) { return html_of(quantity); },
          [](const Badge& badge) { return tag(badge); },
          [](const Mark& one) {
            return fmt::format("<span class=\"tag {}\" role=\"img\" aria-label=\"{}\">{}</span>",
                               css(one.state), escaped(one.words), mark(one.state));
          },
          [](const Link& link) {
            return fmt::format("<a href=\"{}\">{}</a>", escaped(link.to), escaped(link.words));
          },
          [](const Soft& soft) {
            return fmt::format("<span class=\"soft\">{}</span>", escaped(soft.words));
          },
          [](const Symbol& symbol) {
            const PrintedSymbol printed = printed_symbol(symbol.words);
            std::string text = escaped(printed.letter);
            if (!printed.subscript.empty())
              text += fmt::format("<sub>{}</sub>", escaped(printed.subscript));
            return fmt::format("<var class=\"soft\">{}{}</var>", text, escaped(printed.argument));
          },
          [](const Strong& strong) {
            return fmt::format("<strong>{}</strong>", escaped(strong.words));
          },
          [](const Code& code) { return fmt::format("<code>{}</code>", escaped(code.words)); },
          [](const Aside& aside) { return escaped(aside.words); },
      },
      part);
}

std::string html_attribute(const char* name, const std::string& value) {
  return value.empty() ? std::string() : fmt::format(" {}=\"{}\"", name, escaped(value));
}

void add_tile(const Tile& tile, std::string& page) {
  const char* const element = tile.to.empty() ? "span" : "a";
  page += fmt::format(
      "<{} class=\"cell {}\"{}{}><span class=\"mark\" role=\"img\" aria-label=\"{}\">{}</span>",
      element, css(tile.badge.state), html_attribute("href", tile.to),
      html_attribute("title", tile.title), escaped(tile.badge.words), mark(tile.badge.state));
  page += html(tile.line);
  for (const Line& line : tile.below) page += "<small>" + html(line) + "</small>";
  if (tile.picture) page += svg(*tile.picture);
  page += fmt::format("</{}>", element);
}

std::string shade_of(double shade) {
  return fmt::format(" style=\"--r:{:.2f}\"", std::min(1.0, std::abs(shade)));
}

void add_content(const Cell& cell, std::string& page) {
  for (const Tile& tile : cell.tiles) add_tile(tile, page);
  if (cell.picture) page += svg(*cell.picture);
  page += html(cell.line);
  for (const Line& line : cell.paragraphs) page += "<p>" + html(line) + "</p>";
  if (cell.portion)
    page += fmt::format("<span class=\"portion\"><span style=\"width:{:.1f}%\"></span></span>",
                        100.0 * std::clamp(*cell.portion, 0.0, 1.0));
  bool first = cell.line.empty();
  for (const Line& line : cell.below) {
    if (!first) page += "<br> ";  // a phone hides the break, and the space separates the words
    page += "<small>" + html(line) + "</small>";
    first = false;
  }
}

const char* class_of(Column::Kind kind) {
  switch (kind) {
    case Column::Kind::text:
      return "";
    case Column::Kind::number:
      return "n";
    case Column::Kind::unit:
      return "nowrap apart";
    case Column::Kind::words:
      return "words";
  }
  return "";
}

void add_row(const Table& table, const Row& row, std::string& page) {
  assert(row.cells.size() == table.columns.size());
  page += fmt::format("<tr{}>", html_attribute("id", row.id));
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const Cell& cell = row.cells[i];
    const Column& column = table.columns[i];
    if (i == table.heading) {
      page += "<th scope=\"row\">";
      add_content(cell, page);
      page += "</th>";
      continue;
    }
    std::string classes = class_of(column.kind);
    if (cell.shade) classes += *cell.shade < 0.0 ? " minus" : " plus";
    page += "<td" + html_attribute("class", classes);
    if (table.shape == Table::Shape::cards) page += html_attribute("data-label", column.title);
    if (cell.shade) page += shade_of(*cell.shade);
    page += ">";
    add_content(cell, page);
    // A card shows the unit after the value.
    if (table.shape == Table::Shape::cards && i + 1 < row.cells.size() &&
        table.columns[i + 1].kind == Column::Kind::unit)
      page += "<span class=\"beside-value\"> " + html(row.cells[i + 1].line) + "</span>";
    page += "</td>";
  }
  page += "</tr>\n";
  for (const std::string& note : row.notes)
    page += fmt::format(
        "<tr class=\"note\"><td colspan=\"{}\"><span class=\"keep\">{}</span></td></tr>\n",
        row.cells.size(), escaped(note));
}

std::string table_class(const Table& table) {
  std::string classes = table.style;
  const auto add = [&](const char* name) {
    classes += (classes.empty() ? "" : " ") + std::string(name);
  };
  if (table.shape == Table::Shape::cards) add("stack");
  if (table.shape == Table::Shape::matrix) add("matrix");
  return html_attribute("class", classes);
}

/// Formats the count of omitted rows: "2200 more, in fit.json."; empty if none was omitted.
std::string rest_of(std::size_t count, const std::string& file) {
  if (count == 0) return {};
  return fmt::format("<p class=\"source\">{} more{}.</p>\n", count,
                     file.empty() ? "" : ", in " + escaped(file));
}

void add(const Table& table, std::string& page) {
  page += fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">\n<table{}>\n",
      escaped(table.label), table_class(table));
  page += table.caption.empty()
              ? fmt::format("<caption class=\"hidden\">{}</caption>", escaped(table.label))
              : "<caption>" + html(table.caption) + "</caption>";
  page += "\n<thead><tr>";
  for (const Column& column : table.columns) {
    page += "<th scope=\"col\"" + html_attribute("class", class_of(column.kind)) + ">" +
            escaped(column.title);
    if (!column.below.empty()) page += "<br> <small>" + escaped(column.below) + "</small>";
    page += "</th>";
  }
  page += "</tr></thead>\n<tbody>\n";
  const std::size_t shown = std::min(table.most, table.rows.size());
  for (std::size_t i = 0; i < shown; ++i) add_row(table, table.rows[i], page);
  page += "</tbody>\n</table>\n</div>\n";
  page += rest_of(table.rows.size() - shown, table.file);
}

void add(const Paragraph& paragraph, std::string& page) {
  const auto name = [&] {
    switch (paragraph.tone) {
      case Paragraph::Tone::plain:
        return "";
      case Paragraph::Tone::reading:
      case Paragraph::Tone::picture:
        return "reading";
      case Paragraph::Tone::source:
      case Paragraph::Tone::small:
        return "source";
      case Paragraph::Tone::problem:
        return "problem";
      case Paragraph::Tone::screen:
        return "reading screen";
    }
    return "";
  };
  page += "<p" + html_attribute("class", name()) + ">" + html(paragraph.line) + "</p>\n";
}

void add(const Heading& heading, std::string& page) {
  page += fmt::format("<h{0}>{1}</h{0}>\n", heading.level, html(heading.line));
}

/// Maximum number of list items on a page; nobody reads more. Lists begin with the most serious
/// items.
constexpr std::size_t kMostItems = 100;

void add(const List& list, std::string& page) {
  if (list.items.empty()) return;
  page += "<ul" +
          html_attribute("class", list.state ? fmt::format("reasons {}", css(*list.state)) : "") +
          ">";
  const std::size_t shown = std::min(kMostItems, list.items.size());
  for (std::size_t i = 0; i < shown; ++i) page += "<li>" + html(list.items[i]) + "</li>";
  page += "</ul>\n";
  page += rest_of(list.items.size() - shown, {});
}

void add(const Facts& facts, std::string& page) {
  if (facts.rows.empty()) return;
  if (facts.shape == Facts::Shape::grid) {
    page += "<dl class=\"identity\">";
    for (const auto& [name, value] : facts.rows)
      page += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escaped(name), html(value));
    page += "</dl>\n";
    return;
  }
  page += "<table class=\"facts\">\n" +
          (facts.caption.empty()
               ? fmt::format("<caption class=\"hidden\">{}</caption>", escaped(facts.label))
               : "<caption>" + html(facts.caption) + "</caption>") +
          "\n<tbody>";
  for (const auto& [name, value] : facts.rows)
    page +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escaped(name), html(value));
  page += "</tbody>\n</table>\n";
}

void add(const Figure& figure, std::string& page) {
  page += figure.narrow ? "<figure class=\"narrow\">" : "<figure>";
  if (!figure.caption.empty()) page += "<figcaption>" + escaped(figure.caption) + "</figcaption>";
  page += svg(figure.plot());
  if (!figure.reading.empty()) page += "<p class=\"reading\">" + escaped(figure.reading) + "</p>";
  page += "</figure>\n";
}

void add(const Gallery& gallery, std::string& page) {
  if (gallery.figures.empty()) return;
  page += gallery.wide ? "<div class=\"wide-plots\">" : "<div class=\"small-plots\">";
  for (const Figure& figure : gallery.figures) add(figure, page);
  page += "</div>\n";
}

void add(const Verdict& verdict, std::string& page) {
  page += fmt::format(
      "<div class=\"verdict {}\">\n<p class=\"word\">{}</p>\n<div>\n<p class=\"sentence\">{}</p>\n",
      css(verdict.badge.state), marked(verdict.badge), html(verdict.sentence));
  if (!verdict.reasons.empty()) {
    page += "<ol>";
    for (const Line& reason : verdict.reasons) page += "<li>" + html(reason) + "</li>";
    page += "</ol>\n";
  }
  if (verdict.more > 0)
    page += fmt::format("<p class=\"more\">and {} more, below.</p>\n", verdict.more);
  page += "</div>\n</div>\n";
}

void add(const Doubts& doubts, std::string& page) {
  Lines items = doubts.items;
  if (doubts.warnings) items.push_back(*doubts.warnings);
  if (items.empty()) return;
  page += fmt::format(
      "<div class=\"doubts\"><p><strong>Before you sign: {} point{}.</strong></p>\n<ol>",
      items.size(), items.size() == 1 ? "" : "s");
  for (const Line& item : items) page += "<li>" + html(item) + "</li>";
  page += "</ol></div>\n";
}

void add(const Aspects& aspects, std::string& page) {
  page += "<div class=\"four\">";
  for (const Aspects::Aspect& aspect : aspects.aspects) {
    page += fmt::format(
        "<div class=\"{0}\"><p class=\"aspect\"><span role=\"img\" aria-label=\"{1}\">{2}</span> "
        "{3}</p>",
        css(aspect.badge.state), escaped(aspect.badge.words), mark(aspect.badge.state),
        escaped(aspect.name));
    for (const Line& line : aspect.lines) page += "<p>" + html(line) + "</p>";
    page += "</div>";
  }
  page += "</div>\n";
}

void add(const Signatures& signatures, std::string& page) {
  if (signatures.rows.empty()) return;
  page += "<div class=\"signatures\">";
  for (const auto& [what, who] : signatures.rows)
    page += fmt::format("<p>{}{}<span class=\"date\">Date</span></p>", escaped(what),
                        who.empty() ? std::string() : " " + escaped(who));
  page += "</div>\n";
}

void add(const Command& command, std::string& page) {
  page += "<pre><code>" + escaped(command.words) + "</code></pre>\n";
}

void add(const Rendered& rendered, std::string& page) { page += rendered.html; }

void add(const Fold& fold, std::string& page) {
  page += fmt::format("<details{}{}>\n<summary>{}</summary>\n", html_attribute("class", fold.style),
                      fold.open ? " open" : "", escaped(fold.summary));
  render_html(fold.blocks, page);
  page += "</details>\n";
}

void add(const Article& article, std::string& page) {
  const std::string id = escaped(article.id);
  page += fmt::format(
      "<article class=\"condition\" id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h3 "
      "id=\"{0}-title\">{1}</h3>\n",
      id, html(article.title));
  render_html(article.blocks, page);
  page += "</article>\n";
}

void add(const LivePlot& live, std::string& page) {
  page += fmt::format(
      "<figure class=\"plot\" data-plot=\"{}\" data-file=\"{}\" tabindex=\"0\" role=\"group\" "
      "aria-label=\"{}\">\n<figcaption>{}</figcaption>\n<div class=\"static-plot\">",
      live.number, escaped(live.file), escaped(live.description), escaped(live.caption));
  page += svg(live.plot());
  page += "</div>\n</figure>\n";
}

void add(const LiveSeries& series, std::string& page) {
  page += "<script type=\"application/json\" class=\"series\">" + series.json + "</script>\n";
}

/// Number of sketches in one compressed stream. The browser unpacks a whole stream to open one of
/// its sketches.
constexpr std::size_t kSketchesInStream = 40;

void add(const Sketches& all, std::string& page) {
  const std::vector<Sketches::Sketch>& sketches = all.sketches;
  page += fmt::format("<div class=\"sketches\" data-each=\"{}\">\n", kSketchesInStream);
  for (const Sketches::Sketch& sketch : sketches)
    page += fmt::format("<details class=\"sketch\" id=\"{}\"><summary>{} {}</summary></details>\n",
                        escaped(sketch.id), tag(sketch.badge), html(sketch.line));
  for (std::size_t begin = 0; begin < sketches.size(); begin += kSketchesInStream) {
    std::string json;
    for (std::size_t i = begin; i < std::min(begin + kSketchesInStream, sketches.size()); ++i)
      json += (json.empty() ? "[" : ",") + sketches[i].json;
    page += fmt::format("<script type=\"text/plain\" class=\"packed\">{}</script>\n",
                        base64(deflated(json + "]")));
  }
  page += "</div>\n";
}

}  // namespace

std::string_view mark(State state) {
  switch (state) {
    case State::none:
      return "○";
    case State::good:
      return "✓";
    case State::warn:
      return "!";
    case State::bad:
      return "✕";
  }
  return "";
}

std::string_view css(State state) {
  switch (state) {
    case State::none:
      return "none";
    case State::good:
      return "good";
    case State::warn:
      return "warn";
    case State::bad:
      return "bad";
  }
  return "";
}

std::string html(const Line& line) {
  std::string text;
  for (const Inline& part : line) text += html_of(part);
  return text;
}

void render_html(const Blocks& blocks, std::string& page) {
  for (const Block& block : blocks) std::visit([&](const auto& each) { add(each, page); }, block);
}

void render_html(const Section& section, std::string& page) {
  const std::string id = escaped(section.id);
  page += fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n", id,
      escaped(section.title));
  render_html(section.blocks, page);
  page += "</section>\n\n";
}

}  // namespace rigcal::report::doc
