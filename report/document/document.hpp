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

// A result as people read it, without a word on how it is drawn: render_html() and
// render_terminal() alone know pages and terminals. Texts are plain; the renderers escape them.

namespace rigcal::report::doc {

/// What a result means to its reader: its colour and its mark, with words beside it always.
enum class State { none, good, warn, bad };
/// "○", "✓", "!", "✕"
std::string_view mark(State state);
/// Class of the style sheet: "none", "good", "warn", "bad".
std::string_view css(State state);

/// A number: as the file holds it, and in the digits that it deserves. quantity.hpp makes them.
struct Quantity {
  std::optional<double> exact;
  std::string text = "–";
  std::string unit = {};  ///< empty where there is none, or a column of its own has it
};
struct Badge {
  State state = State::none;
  std::string words;
};
/// A badge as its mark alone; the words are for a screen reader.
struct Mark {
  State state = State::none;
  std::string words;
};
struct Link {
  std::string to;  ///< "#id", or a file
  std::string words;
};
/// Symbols, remarks.
struct Soft {
  std::string words;
};
struct Strong {
  std::string words;
};
/// What is typed: a key, a command.
struct Code {
  std::string words;
};
using Inline = std::variant<std::string, Quantity, Badge, Mark, Link, Soft, Strong, Code>;
using Line = std::vector<Inline>;
using Lines = std::vector<Line>;

/// One of several results in a cell or a gallery, coloured as a whole.
struct Tile {
  Badge badge;
  Line line;
  Lines below = {};
  std::string to = {};     ///< "#id" that it leads to
  std::string title = {};  ///< what a pointer over it is told
  std::optional<Plot> picture = {};
};

struct Cell {
  Line line = {};
  Lines paragraphs = {};               ///< after it, one below the other
  Lines below = {};                    ///< smaller
  std::vector<Tile> tiles = {};        ///< in place of a line
  std::optional<Plot> picture = {};    ///< in place of a line, on the page alone
  std::optional<double> shade = {};    ///< -1 to 1: colour of the cell
  std::optional<double> portion = {};  ///< 0 to 1: a bar that is filled so far, above `below`

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
  int spare = 0;           ///< the highest leaves a narrow terminal first; 0: never
  std::string below = {};  ///< of the title, on the page
};

struct Row {
  std::vector<Cell> cells;
  std::vector<std::string> notes = {};  ///< reasons that hold for the whole row
  std::string id = {};
};

struct Table {
  /// A matrix has tiles of equal width; a row of cards becomes one on a narrow screen.
  enum class Shape { list, cards, matrix };
  std::string label;  ///< for screen readers; the caption where there is none
  Line caption = {};
  Shape shape = Shape::list;
  std::string style = {};   ///< class of the style sheet
  std::size_t heading = 0;  ///< column that names a row
  std::size_t keys = 1;     ///< leading columns that every block of a narrow terminal repeats
  std::string file = {};    ///< that has what a narrow terminal leaves out
  std::vector<Column> columns = {};
  std::vector<Row> rows = {};
};

struct Paragraph {
  enum class Tone {
    plain,
    reading,
    source,
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
  std::optional<State> state = {};  ///< of reasons and warnings: their colour
};

/// Names with values: of a test, a program, a range.
struct Facts {
  enum class Shape { table, grid };
  std::string label;
  std::vector<std::pair<std::string, Line>> rows = {};
  Line caption = {};
  Shape shape = Shape::table;
};

/// A plot is made when it is drawn, so that those of a whole page are never in memory at once.
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

/// The first thing of a page: its verdict in a word and in a sentence with numbers.
struct Verdict {
  Badge badge;
  Line sentence;
  Lines reasons = {};
  std::size_t more = 0;  ///< reasons beside these
};
/// What whoever signs has to know first.
struct Doubts {
  Lines items;
};
/// Things that are judged apart, side by side.
struct Aspects {
  struct Aspect {
    Badge badge;
    std::string name;
    Lines lines;
  };
  std::vector<Aspect> aspects;
};
/// Lines to sign on: what is signed for, and by whom.
struct Signatures {
  std::vector<std::pair<std::string, std::string>> rows;
};
/// What was typed to make a result.
struct Command {
  std::string words;
};
/// Markup that something else has made.
struct Raw {
  std::string html;
};

/// A picture that a page may replace by one that zooms, of the series in its article.
struct LivePlot {
  std::size_t number = 0;   ///< of the plot in the series
  std::string file;         ///< that it is saved as
  std::string description;  ///< what a screen reader says of it
  std::string caption;
  std::function<Plot()> plot;
};
/// Series of the live plots of an article, as report.js reads them.
struct LiveSeries {
  std::string json;
};

struct Fold;
struct Article;
using Block =
    std::variant<Paragraph, Heading, List, Facts, Table, Figure, Gallery, Tiles, Verdict, Doubts,
                 Aspects, Signatures, Command, Raw, LivePlot, LiveSeries, Fold, Article>;
using Blocks = std::vector<Block>;
/// What is opened by whoever wants it; on paper it is open.
struct Fold {
  std::string summary;
  Blocks blocks;  // an initialiser here would need to know Block
  bool open = false;
  std::string style = {};  ///< class of the style sheet
};
/// One of several things of a section, which links lead to.
struct Article {
  std::string id;
  Line title;
  Blocks blocks;
};

struct Section {
  std::string id;
  std::string title;
  Blocks blocks = {};
  std::string short_title = {};  ///< in lists of sections
};

}  // namespace rigcal::report::doc
