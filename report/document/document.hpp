#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "report/figure/svg.hpp"

// A result as a document, independent of its output: only render_html() and render_terminal() know
// about pages and terminals. Texts are plain; the renderers escape them.

namespace rigcal::report::doc {

/// Meaning of a result to its reader. It sets colour and mark; words always accompany it.
enum class State { none, good, warn, bad };
/// "○", "✓", "!", "✕"
std::string_view mark(State state);
/// Class of the style sheet: "none", "good", "warn", "bad".
std::string_view css(State state);

/// A number: the exact value, and the text with the digits that are significant (quantity.hpp).
struct Quantity {
  std::optional<double> exact;
  std::string text = "–";
  std::string unit = {};  ///< empty if there is none, or if another column shows it
};
struct Badge {
  State state = State::none;
  std::string words;
};
/// A badge without visible words; a screen reader reads them.
struct Mark {
  State state = State::none;
  std::string words;
};
struct Link {
  std::string to;  ///< "#id", or a file
  std::string words;
};
/// Symbols and remarks in a lighter colour.
struct Soft {
  std::string words;
};
struct Strong {
  std::string words;
};
/// Text that a user types: a key, a command.
struct Code {
  std::string words;
};
/// Text that only a page has room for, or that explains a picture.
struct Aside {
  std::string words;
};
using Inline = std::variant<std::string, Quantity, Badge, Mark, Link, Soft, Strong, Code, Aside>;
using Line = std::vector<Inline>;
using Lines = std::vector<Line>;

/// One of several results in a cell or a gallery, with its own colour.
struct Tile {
  Badge badge;
  Line line;
  Lines below = {};
  std::string to = {};     ///< link to "#id"
  std::string title = {};  ///< tooltip
  std::optional<Plot> picture = {};
};

struct Cell {
  Line line = {};
  Lines paragraphs = {};               ///< after it, one below the other
  Lines below = {};                    ///< smaller
  std::vector<Tile> tiles = {};        ///< in place of a line
  std::optional<Plot> picture = {};    ///< in place of a line, on the page alone
  std::optional<double> shade = {};    ///< -1 to 1: colour of the cell
  std::optional<double> portion = {};  ///< 0 to 1: filled fraction of a bar above `below`

  Cell() = default;
  // NOLINTBEGIN(google-explicit-constructor): most cells are a text, a number or a line
  Cell(Line content) : line(std::move(content)) {}
  template <typename T>
  requires std::constructible_from<Inline, T> Cell(T&& content)
      : line{Inline(std::forward<T>(content))} {}
  // NOLINTEND(google-explicit-constructor)
};

struct Column {
  enum class Kind { text, number, unit, words };
  std::string title;
  Kind kind = Kind::text;
  int spare = 0;  ///< the column with the highest number is the first that a narrow terminal omits;
                  ///< 0: never
  std::string below = {};  ///< second line of the title, on the page
};

struct Row {
  std::vector<Cell> cells;
  std::vector<std::string> notes = {};  ///< reasons that apply to the whole row
  std::string id = {};
};

struct Table {
  /// A matrix has tiles of equal width; on a narrow screen each row of cards becomes a card.
  enum class Shape { list, cards, matrix };
  std::string label;  ///< for screen readers; the caption if there is none
  Line caption = {};
  Shape shape = Shape::list;
  std::string style = {};   ///< class of the style sheet
  std::size_t heading = 0;  ///< index of the column that names the row
  std::size_t keys = 1;     ///< leading columns, repeated in every block of a narrow terminal
  std::string file = {};    ///< file with the columns and rows that are omitted
  std::size_t most = 1000;  ///< rows on a page, about twenty printed sheets; more are only counted
  std::vector<Column> columns = {};
  std::vector<Row> rows = {};
};

struct Paragraph {
  enum class Tone {
    plain,
    reading,
    source,  ///< small print, on the page alone
    small,   ///< small print
    problem,
    screen,   ///< not in print
    picture,  ///< how to read a picture, or where to click: on the page alone
  };
  Line line;
  Tone tone = Tone::reading;
};
inline Paragraph reading(std::string text) { return {Line{std::move(text)}}; }
inline Paragraph about_picture(std::string text) {
  return {Line{std::move(text)}, Paragraph::Tone::picture};
}

struct Heading {
  Line line;
  int level = 3;
};

struct List {
  Lines items;
  std::optional<State> state = {};  ///< colour of reasons and warnings
};

/// Names with values, of a test, a program or a range.
struct Facts {
  enum class Shape { table, grid };
  std::string label;
  std::vector<std::pair<std::string, Line>> rows = {};
  Line caption = {};
  Shape shape = Shape::table;
};

/// A plot is made only when it is drawn, so that the plots of a page are never in memory together.
struct Figure {
  std::function<Plot()> plot;
  std::string caption = {};
  bool narrow = false;
  std::string reading = {};
};
/// Figures side by side.
struct Gallery {
  std::vector<Figure> figures = {};
  bool wide = false;
};
/// Small pictures of many things of one kind, each with its verdict.
struct Tiles {
  std::vector<Tile> tiles;
};

/// The beginning of a page: the verdict as a badge, and a sentence with numbers.
struct Verdict {
  Badge badge;
  Line sentence;
  Lines reasons = {};
  std::size_t more = 0;  ///< number of further reasons
};
/// Everything that must be known before the result is signed.
struct Doubts {
  Lines items;
  std::optional<Line> warnings = {};  ///< the last item of a page; a terminal shows their section
};
/// Aspects that are judged separately, side by side.
struct Aspects {
  struct Aspect {
    Badge badge;
    std::string name;
    Lines lines;
  };
  std::vector<Aspect> aspects;
};
/// Lines for signatures: what each one certifies, and the name.
struct Signatures {
  std::vector<std::pair<std::string, std::string>> rows;
};
/// The command that produced a result.
struct Command {
  std::string words;
};
/// A picture that the page's script replaces by one with zoom, from the series of its article.
struct LivePlot {
  std::size_t number = 0;   ///< index of the plot in the series
  std::string file;         ///< file name for saving it
  std::string description;  ///< text for screen readers
  std::string caption;
  std::function<Plot()> plot;
};
/// Series of the live plots of an article, as report.js reads them.
struct LiveSeries {
  std::string json;
};
/// Many things of one kind, a line each. The page's script draws one when a reader opens its line.
struct Sketches {
  struct Sketch {
    std::string id;
    Badge badge;
    Line line;
    std::string json;  ///< what the script draws; empty if there is nothing to draw
  };
  std::vector<Sketch> sketches;
};

struct Fold;
struct Article;
struct Rendered;
using Block = std::variant<Paragraph, Heading, List, Facts, Table, Figure, Gallery, Tiles, Verdict,
                           Doubts, Aspects, Signatures, Command, LivePlot, LiveSeries, Sketches,
                           Fold, Article, Rendered>;
using Blocks = std::vector<Block>;
/// Content that the reader can unfold; it is printed unfolded.
struct Fold {
  std::string summary;
  Blocks blocks;  // an initialiser here would need to know Block
  bool open = false;
  std::string style = {};  ///< class of the style sheet
};
/// Part of a section that links can point to.
struct Article {
  std::string id;
  Line title;
  Blocks blocks;
};
/// Blocks that are a page already, and what a terminal shows of them: those of a long page would
/// need most of its memory.
struct Rendered {
  std::string html;
  Blocks blocks;
};

struct Section {
  std::string id;
  std::string title;
  Blocks blocks = {};
  std::string short_title = {};  ///< in lists of sections
  bool always = false;  ///< a terminal shows it below the first page, whatever the style asks for
};

/// A result as its page and a terminal show it.
struct Document {
  Verdict verdict;
  Blocks front = {};  ///< below the verdict, on the page that is signed
  std::vector<Section> sections = {};
  bool synthetic = false;  ///< whether its records are synthetic
};

}  // namespace rigcal::report::doc
