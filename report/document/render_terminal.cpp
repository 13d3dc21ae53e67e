#include "report/document/render_terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "report/document/overloaded.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report::doc {
namespace {

/// Maximum width of a table cell in characters; longer text is wrapped. About as much as one reads
/// at a glance.
constexpr std::size_t kCellColumns = 48;

/// Minimum number of rows in the first table, however few lines are left: that table contains the
/// result itself.
constexpr std::size_t kFirstRows = 8;

const char* colour_of(State state) {
  switch (state) {
    case State::none:
      return "";
    case State::good:
      return "32";
    case State::warn:
      return "33";
    case State::bad:
      return "31";
  }
  return "";
}

/// Writes blocks one after the other.
class Terminal {
 public:
  /// @param most      maximum number of rows in each table
  /// @param is_brief  omits the sentences that explain how to read a result
  Terminal(const Style& style, std::size_t most, bool is_brief)
      : style_(style), most_(most), is_brief_(is_brief) {}

  void add(const Verdict& verdict) {
    add_wrapped(text_of(verdict.badge) + ": " + text_of(verdict.sentence), 2);
    for (const Line& reason : verdict.reasons) add_wrapped("  - " + text_of(reason), 4);
    if (verdict.more > 0) text_ += fmt::format("  and {} more\n", verdict.more);
  }

  void add(const Section& section) {
    if (!shows(section.blocks)) return;
    text_ += "\n" + in_colour(section.title, "1") + "\n";
    add(section.blocks);
  }
  void add(const Blocks& blocks) {
    const Heading* pending = nullptr;  // a heading is printed only once something follows it
    starts_section_ = true;
    for (const Block& block : blocks) {
      if (const auto* heading = std::get_if<Heading>(&block)) {
        pending = heading;
        continue;
      }
      if (!shows(block)) continue;
      if (pending != nullptr) {
        text_ += "\n" + in_colour(text_of(pending->line), "1") + "\n";
        starts_section_ = true;
      }
      pending = nullptr;
      std::visit(
          Overloaded{
              [&](const Table& table) { add(table); },
              [&](const List& list) {
                const char* const start = is_warning(block) ? "warning: " : "- ";
                const std::size_t count = std::min(most_, list.items.size());
                for (std::size_t i = 0; i < count; ++i)
                  add_wrapped(start + text_of(list.items[i]), 2);
                add_count(list.items.size() - count);
              },
              [&](const Facts& facts) { add(facts); },
              [&](const Paragraph& paragraph) {
                const std::string text = text_of(paragraph.line);
                add_wrapped(
                    paragraph.tone == Paragraph::Tone::problem ? in_colour(text, "31") : text, 0);
              },
              [&](const Figure& figure) { add_wrapped(figure.reading, 2); },
              [&](const Gallery& gallery) {
                for (const Figure& figure : gallery.figures)
                  if (!figure.reading.empty()) add_wrapped(figure.reading, 2);
              },
              [&](const Fold& fold) {
                text_ += "\n" + in_colour(fold.summary, "1") + "\n";
                for (const Block& inner : fold.blocks)
                  if (is_open(fold) || is_warning(inner)) add(Blocks{inner});
              },
              [&](const Doubts& doubts) {
                text_ += "\n" + in_colour("Before you sign", "1") + "\n";
                for (const Line& item : doubts.items) add_wrapped("- " + text_of(item), 2);
              },
              [&](const Aspects& aspects) {
                for (const Aspects::Aspect& aspect : aspects.aspects)
                  add_wrapped(
                      text_of(aspect.badge) + " " + aspect.name + ": " + joined(aspect.lines, "; "),
                      2);
              },
              [&](const Rendered& rendered) { add(rendered.blocks); },
              [&](const Sketches& all) {
                for (const Sketches::Sketch& sketch : all.sketches)
                  add_wrapped(sketch.badge.words + " " + text_of(sketch.line), 2);
              },
              [&](const Article& article) {
                text_ += "\n" + in_colour(text_of(article.title), "1") + "\n";
                add(article.blocks);
              },
              [](const auto&) {},
          },
          block);
      starts_section_ = false;
    }
  }

  void add_wrapped(const std::string& line, std::size_t indent) {
    text_ += wrapped(line, style_.columns, indent) + "\n";
  }

  std::string text() && { return std::move(text_); }

 private:
  static bool is_warning(const Block& block) {
    const auto* list = std::get_if<List>(&block);
    return list != nullptr && list->state && *list->state != State::none;
  }

  bool shows(const Blocks& blocks) const {
    return std::any_of(blocks.begin(), blocks.end(),
                       [&](const Block& block) { return shows(block); });
  }

  bool is_open(const Fold& fold) const { return fold.open || style_.everything; }

  /// Returns true if a block has anything to show on a terminal.
  bool shows(const Block& block) const {
    return std::visit(
        Overloaded{
            [](const Table& table) { return !table.rows.empty(); },
            [](const List& list) { return !list.items.empty(); },
            [](const Facts& facts) { return !facts.rows.empty(); },
            [&](const Paragraph& paragraph) {
              using Tone = Paragraph::Tone;
              return paragraph.tone == Tone::plain || paragraph.tone == Tone::problem ||
                     paragraph.tone == Tone::small ||
                     (paragraph.tone == Tone::reading && !is_brief_);
            },
            [](const Figure& figure) { return !figure.reading.empty(); },
            [](const Gallery& gallery) {
              return std::any_of(gallery.figures.begin(), gallery.figures.end(),
                                 [](const Figure& figure) { return !figure.reading.empty(); });
            },
            [&](const Fold& fold) {
              return std::any_of(fold.blocks.begin(), fold.blocks.end(), [&](const Block& inner) {
                return (is_open(fold) || is_warning(inner)) && shows(inner);
              });
            },
            [](const Doubts& doubts) { return !doubts.items.empty(); },
            [](const Aspects& aspects) { return !aspects.aspects.empty(); },
            [](const Article&) { return true; },
            [](const Sketches& all) { return !all.sketches.empty(); },
            [&](const Rendered& rendered) { return shows(rendered.blocks); },
            [](const auto&) { return false; },
        },
        block);
  }

  void add(const Table& table) {
    if (!table.caption.empty())
      text_ += "\n" + in_colour(text_of(table.caption), "1") + "\n";
    else if (!starts_section_)
      text_ += "\n";
    std::vector<std::size_t> used;  // columns that have something to show on a terminal
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const bool is_used = std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& row) {
        return !lines_of(row.cells[i]).empty();
      });
      if (is_used) used.push_back(i);
    }
    std::vector<TextTable::Column> columns;
    for (const std::size_t i : used) {
      const Column& column = table.columns[i];
      columns.push_back(
          {column.title,
           column.kind == Column::Kind::number ? TextTable::Align::right : TextTable::Align::left,
           column.spare});
    }
    TextTable shown(columns, table.keys);
    const std::size_t most = is_first_table_ ? std::max(most_, kFirstRows) : most_;
    const std::size_t count = std::min(most, table.rows.size());
    is_first_table_ = false;
    std::vector<std::string> notes;
    for (std::size_t r = 0; r < count; ++r) {
      const Row& row = table.rows[r];
      std::vector<std::vector<std::string>> cells;
      for (const std::size_t i : used) {
        cells.push_back(broken(lines_of(row.cells[i])));
      }
      shown.add_lines(std::move(cells));
      for (const std::string& note : row.notes)
        notes.push_back(
            fmt::format("{}: {}", fmt::join(lines_of(row.cells[table.heading]), " "), note));
    }
    text_ += shown.text(style_.columns);
    add_count(table.rows.size() - count);
    if (const auto left_out = shown.left_out(style_.columns); !left_out.empty())
      add_wrapped(fmt::format("hidden on this narrow terminal: {}", fmt::join(left_out, ", ")), 2);
    for (const std::string& note : notes) add_wrapped(note, 2);
  }

  void add_count(std::size_t more) {
    if (more > 0) text_ += fmt::format("and {} more (-v for all)\n", more);
  }

  void add(const Facts& facts) {
    if (!facts.caption.empty()) text_ += "\n" + in_colour(text_of(facts.caption), "1") + "\n";
    for (const auto& [name, line] : facts.rows) add_wrapped(name + ": " + text_of(line), 2);
  }

  std::string joined(const Lines& lines, std::string_view separator) const {
    std::string text;
    for (const Line& line : lines) {
      if (!text.empty()) text += separator;
      text += text_of(line);
    }
    return text;
  }

  std::string in_colour(const std::string& text, const char* code) const {
    if (!style_.colour || *code == '\0') return text;
    return fmt::format("\x1b[{}m{}\x1b[0m", code, text);
  }

  std::string text_of(const Badge& badge) const {
    return in_colour(on_one_line(badge.words), colour_of(badge.state));
  }

  std::string text_of(const Line& line) const {
    std::string text;
    for (const Inline& part : line) {
      text += std::visit(Overloaded{
                             [](const std::string& words) { return on_one_line(words); },
                             [](const Quantity& quantity) {
                               return quantity.unit.empty() ? quantity.text
                                                            : quantity.text + " " + quantity.unit;
                             },
                             [&](const Badge& badge) { return text_of(badge); },
                             [&](const Mark& one) {
                               return in_colour(std::string(mark(one.state)), colour_of(one.state));
                             },
                             [](const Aside&) { return std::string(); },
                             [](const auto& other) { return on_one_line(other.words); },
                         },
                         part);
    }
    return text;
  }

  /// Returns "✓ 0.250", followed by the lines below it.
  std::vector<std::string> lines_of(const Tile& tile) const {
    std::string first = text_of(tile.line);
    if (tile.badge.state != State::none)
      first =
          in_colour(std::string(mark(tile.badge.state)), colour_of(tile.badge.state)) + " " + first;
    std::vector<std::string> lines{std::move(first)};
    for (const Line& line : tile.below) lines.push_back(text_of(line));
    return lines;
  }

  std::vector<std::string> lines_of(const Cell& cell) const {
    std::vector<std::string> lines;
    for (const Tile& tile : cell.tiles)
      for (std::string& line : lines_of(tile)) lines.push_back(std::move(line));
    if (!cell.line.empty()) lines.push_back(text_of(cell.line));
    for (const Lines* more : {&cell.paragraphs, &cell.below})
      for (const Line& line : *more) lines.push_back(text_of(line));
    lines.erase(std::remove(lines.begin(), lines.end(), std::string()), lines.end());
    return lines;
  }

  static std::vector<std::string> broken(const std::vector<std::string>& lines) {
    std::vector<std::string> result;
    for (const std::string& line : lines) {
      std::string rest = wrapped(line, kCellColumns, 0);
      for (std::size_t end = 0; (end = rest.find('\n')) != std::string::npos;) {
        result.push_back(rest.substr(0, end));
        rest.erase(0, end + 1);
      }
      result.push_back(std::move(rest));
    }
    return result;
  }

  Style style_;
  std::size_t most_;
  bool is_brief_;
  std::string text_;
  bool is_first_table_ = true;
  bool starts_section_ = true;  ///< nothing has been printed since the last title
};

/// Names the sections of a document that a terminal shows only on request.
std::string further_sections(const Document& document) {
  std::string text;
  for (const Section& section : document.sections)
    if (!section.always) text += (text.empty() ? "-v for more: " : ", ") + section.title;
  return text;
}

std::string rendered(const Document& document, const Style& style, std::size_t most,
                     bool is_brief) {
  Terminal terminal(style, most, is_brief);
  terminal.add(document.verdict);
  terminal.add(document.front);
  const bool all = document.front.empty() || style.everything;
  for (const Section& section : document.sections)
    if (all || section.always) terminal.add(section);
  if (!all) {
    terminal.add_wrapped("", 0);
    terminal.add_wrapped(further_sections(document), 2);
  }
  if (document.synthetic)
    terminal.add_wrapped("note: the records of this campaign are synthetic", 2);
  return std::move(terminal).text();
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

std::string render_terminal(const Document& document, const Style& style) {
  constexpr std::size_t kFewestRows = 3;  // below this, explanatory sentences are omitted
  const std::size_t all = std::numeric_limits<std::size_t>::max();
  std::string text = rendered(document, style, all, false);
  if (style.lines == 0) return text;
  for (std::size_t most = style.lines; most > 0 && lines_in(text) > style.lines; --most)
    text = rendered(document, style, most, most < kFewestRows);
  return text;
}

}  // namespace rigcal::report::doc
