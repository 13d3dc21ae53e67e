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

// A result as a document that does not depend on the output: only render_html() and
// render_terminal() know about pages and terminals. Texts are plain; the renderers escape them.

namespace rigcal::report::doc {

/// What a result means to the reader. The state selects the colour and the mark; words always
/// accompany it.
enum class State { none, good, warn, bad };
/// Returns "○", "✓", "!" or "✕".
std::string_view mark(State state);
/// Returns the style-sheet class: "none", "good", "warn" or "bad".
std::string_view css(State state);

/// A number as its exact value and as text with the significant digits (quantity.hpp).
struct Quantity {
  std::optional<double> exact;
  std::string text = "–";
  std::string unit = {};  ///< empty if dimensionless, or if another column shows the unit
};
struct Badge {
  State state = State::none;
  std::string words;
};
/// A badge whose words are not visible and are read only by screen readers.
struct Mark {
  State state = State::none;
  std::string words;
};
struct Link {
  std::string to;  ///< "#id" or a file
  std::string words;
};
/// Remarks, shown in a lighter colour.
struct Soft {
  std::string words;
};
/// Symbol of a quantity in the equations: "k_sv".
struct Symbol {
  std::string words;
};
struct Strong {
  std::string words;
};
/// Text for the user to type: a key or a command.
struct Code {
  std::string words;
};
/// Text that is shown only on a page, where there is room for it, or that explains a picture.
struct Aside {
  std::string words;
};
using Inline =
    std::variant<std::string, Quantity, Badge, Mark, Link, Soft, Symbol, Strong, Code, Aside>;
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
  Lines paragraphs = {};               ///< one below the other, after the line
  Lines below = {};                    ///< in smaller print
  std::vector<Tile> tiles = {};        ///< shown instead of a line
  std::optional<Plot> picture = {};    ///< shown instead of a line, only on the page
  std::optional<double> shade = {};    ///< background colour on a scale from -1 to 1
  std::optional<double> portion = {};  ///< filled fraction of a bar above `below`, 0 to 1

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
  int spare = 0;  ///< a narrow terminal omits the column with the highest number first; 0: never
  std::string below = {};  ///< second line of the title, shown on the page
};

struct Row {
  std::vector<Cell> cells;
  std::vector<std::string> notes = {};  ///< reasons that apply to the whole row
  std::string id = {};
};

struct Table {
  /// A matrix has tiles of equal width. On a narrow screen each row of a cards table becomes a
  /// card.
  enum class Shape { list, cards, matrix };
  std::string label;  ///< for screen readers; empty: the caption is used
  Line caption = {};
  Shape shape = Shape::list;
  std::string style = {};   ///< class in the style sheet
  std::size_t heading = 0;  ///< index of the column that names the row
  std::size_t keys = 1;     ///< leading columns to repeat in every block on a narrow terminal
  std::string file = {};    ///< file that contains the omitted columns and rows
  std::size_t most = 1000;  ///< maximum number of rows on a page, about twenty printed sheets;
                            ///< further rows are only counted
  std::vector<Column> columns = {};
  std::vector<Row> rows = {};
};

struct Paragraph {
  enum class Tone {
    plain,
    reading,
    source,  ///< small print, only on the page
    small,   ///< small print
    problem,
    screen,   ///< not printed
    picture,  ///< how to read a picture, or where to click; only on the page
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
  std::optional<State> state = {};  ///< colour for reasons and warnings
};

/// Names and values that describe a test, a program or a range.
struct Facts {
  enum class Shape { table, grid };
  std::string label;
  std::vector<std::pair<std::string, Line>> rows = {};
  Line caption = {};
  Shape shape = Shape::table;
};

/// A figure. The plot is created only when it is drawn, so that not all plots of a page are in
/// memory at the same time.
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
/// The beginning of a page: the verdict as a badge, and a sentence with the key numbers.
struct Verdict {
  Badge badge;
  Line sentence;
  Lines reasons = {};
  std::size_t more = 0;  ///< number of further reasons
};
/// Everything the reader must know before signing the result.
struct Doubts {
  Lines items;
  std::optional<Line> warnings = {};  ///< last on a page; a terminal shows the warnings section
};
/// Separately judged aspects, shown side by side.
struct Aspects {
  struct Aspect {
    Badge badge;
    std::string name;
    Lines lines;
  };
  std::vector<Aspect> aspects;
};
/// Signature lines: what each signature certifies, and the name.
struct Signatures {
  std::vector<std::pair<std::string, std::string>> rows;
};
/// The command that produced the result.
struct Command {
  std::string words;
};
/// A picture that the page's script replaces with a zoomable plot, drawn from the series of the
/// article.
struct LivePlot {
  std::size_t number = 0;   ///< index of the plot in the series
  std::string file;         ///< file name for saving the plot
  std::string description;  ///< text for screen readers
  std::string caption;
  std::function<Plot()> plot;
};
/// Data series for the live plots of an article, in the format that report.js reads.
struct LiveSeries {
  std::string json;
};
/// A list of similar items, one line each. The page's script draws an item when the reader opens
/// its line.
struct Sketches {
  struct Sketch {
    std::string id;
    Badge badge;
    Line line;
    std::string json;  ///< data for the script to draw; empty if there is nothing to draw
  };
  std::vector<Sketch> sketches;
};

struct Fold;
struct Article;
struct Rendered;
using Block =
    std::variant<Paragraph, Heading, List, Facts, Table, Figure, Gallery, Verdict, Doubts, Aspects,
                 Signatures, Command, LivePlot, LiveSeries, Sketches, Fold, Article, Rendered>;
using Blocks = std::vector<Block>;
/// Content that the reader can unfold. It is printed unfolded.
struct Fold {
  std::string summary;
  Blocks blocks;  // no initialiser: it would need the complete type Block
  bool open = false;
  std::string style = {};  ///< class of the style sheet
};
/// A subsection that links can point to.
struct Article {
  std::string id;
  Line title;
  Blocks blocks;
};
/// Blocks that are already rendered for the page, and the blocks that a terminal shows instead.
/// Rendering early saves memory, because the blocks of a long page would otherwise take most of it.
struct Rendered {
  std::string html;
  Blocks blocks;
};

struct Section {
  std::string id;
  std::string title;
  Blocks blocks = {};
  std::string short_title = {};  ///< title in lists of sections
  bool always = false;           ///< a terminal shows it below the first page in any style
};

/// A result in the form in which the page and the terminal show it.
struct Document {
  Verdict verdict;
  Blocks front = {};  ///< below the verdict, on the page to be signed
  std::vector<Section> sections = {};
  bool synthetic = false;  ///< whether the records are synthetic
};

}  // namespace rigcal::report::doc
