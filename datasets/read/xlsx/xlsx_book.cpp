#include "datasets/read/xlsx/xlsx_book.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "common/error.hpp"
#include "datasets/read/csv/csv_text.hpp"
#include "datasets/read/xlsx/xlsx_date_format.hpp"
#include "datasets/read/xlsx/xlsx_xml.hpp"

namespace rigcal::datasets {
namespace {

// Excel's own limits, and limits on the inflated size of parts.
constexpr std::size_t kMostRows = 1'048'576;
constexpr std::size_t kMostSheetColumns = 16'384;
constexpr std::size_t kLongestCell = 32'767 * 4;
constexpr std::uint64_t kMostSheetBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostPartBytes = std::uint64_t{64} << 20;
constexpr std::size_t kMostSharedBytes = std::size_t{64} << 20;
constexpr std::size_t kMostSheets = 1000;
constexpr std::size_t kMostStyles = 100'000;
constexpr std::size_t kMostMerged = 100'000;

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct Place {
  std::size_t row = 0;
  std::size_t column = 0;
};

/// Parses an address such as "C17".
std::optional<Place> parsed_address(std::string_view text) {
  Place place;
  std::size_t at = 0;
  for (; at < text.size() && text[at] >= 'A' && text[at] <= 'Z' && at < 4; ++at)
    place.column = 26 * place.column + static_cast<std::size_t>(text[at] - 'A' + 1);
  place.row = whole_number<std::size_t>(text.substr(at)).value_or(0);
  const bool is_possible = place.column >= 1 && place.column <= kMostSheetColumns &&
                           place.row >= 1 && place.row <= kMostRows;
  return is_possible ? std::optional(place) : std::nullopt;
}

/// Resolves the name of a part relative to the folder of the part that refers to it.
std::string resolved(const std::string& from, std::string_view target) {
  if (target.starts_with('/')) return std::string(target.substr(1));
  const auto path = std::filesystem::path(from).parent_path() / target;
  return path.lexically_normal().generic_string();
}

/// Returns the path of the file that lists the references of a part.
std::string relations_of(const std::string& part) {
  const std::filesystem::path path(part);
  return (path.parent_path() / "_rels" / (path.filename().string() + ".rels")).generic_string();
}

// ---- Small parts ---------------------------------------------------------------------------

struct Relation {
  std::string kind;  ///< "worksheet"
  std::string target;
};

/// Collects the references of a part by id.
class RelationsHandler : public XmlHandler {
 public:
  void start(std::string_view element, const XmlAttributes& attributes) override {
    if (element != "Relationship" || relations.size() >= 10 * kMostSheets) return;
    const std::string_view type = attributes.text("Type");
    relations[std::string(attributes.text("Id"))] = {std::string(type.substr(type.rfind('/') + 1)),
                                                     std::string(attributes.text("Target"))};
  }
  std::map<std::string, Relation> relations;
};

bool is_true(std::string_view text) { return text == "1" || text == "true"; }

/// Collects the names of the sheets, and the ids of the references to their parts.
class WorkbookHandler : public XmlHandler {
 public:
  void start(std::string_view element, const XmlAttributes& attributes) override {
    if (element == "calcPr") is_to_be_computed = is_true(attributes.text("fullCalcOnLoad"));
    if (element == "sheet" && sheets.size() < kMostSheets)
      sheets.emplace_back(attributes.text("name"), attributes.text("id"));
  }
  std::vector<std::pair<std::string, std::string>> sheets;
  bool is_to_be_computed = false;
};

/// Collects the texts that cells share, without the phonetic hints of Japanese texts.
class SharedTextsHandler : public XmlHandler {
 public:
  explicit SharedTextsHandler(std::string name) : name_(std::move(name)) {}

  void start(std::string_view element, const XmlAttributes& /*attributes*/) override {
    if (element == "si") text_.clear();
    if (element == "rPh") in_aid_ = true;
    if (element == "t") in_text_ = !in_aid_;
  }
  void end(std::string_view element) override {
    if (element == "rPh") in_aid_ = false;
    if (element == "t") in_text_ = false;
    if (element == "si") texts.push_back(std::exchange(text_, {}));
  }
  void text(std::string_view text) override {
    if (!in_text_) return;
    text_ += text;
    bytes_ += text.size();
    if (bytes_ > kMostSharedBytes)
      throw InputError({name_},
                       fmt::format("contains more than {} MB of text", kMostSharedBytes >> 20));
  }
  std::vector<std::string> texts;

 private:
  std::string name_;
  std::string text_;
  bool in_text_ = false;
  bool in_aid_ = false;
  std::size_t bytes_ = 0;
};

/// Finds the cell styles that show a date.
class StylesHandler : public XmlHandler {
 public:
  void start(std::string_view element, const XmlAttributes& attributes) override {
    const auto number = whole_number<long>(attributes.text("numFmtId"));
    if (element == "numFmt" && number && own_.size() < kMostStyles)
      own_[*number] = is_date_format(attributes.text("formatCode"));
    if (element == "cellXfs") in_cells_ = true;
    if (element != "xf" || !in_cells_ || shows_a_date.size() >= kMostStyles) return;
    const auto own = own_.find(number.value_or(0));
    shows_a_date.push_back(own != own_.end() ? own->second : is_date_format(number.value_or(0)));
  }
  void end(std::string_view element) override {
    if (element == "cellXfs") in_cells_ = false;
  }
  std::vector<bool> shows_a_date;

 private:
  std::map<long, bool> own_;
  bool in_cells_ = false;
};

// ---- Sheets --------------------------------------------------------------------------------

class SheetHandler : public XmlHandler {
 public:
  SheetHandler(std::string file, std::string sheet, const std::vector<std::string>& texts,
               const std::vector<bool>& shows_a_date, bool is_to_be_computed,
               const std::function<bool(const XlsxCell&)>& take)
      : file_(std::move(file)),
        sheet_(std::move(sheet)),
        texts_(texts),
        shows_a_date_(shows_a_date),
        is_to_be_computed_(is_to_be_computed),
        take_(take) {}

  void start(std::string_view element, const XmlAttributes& attributes) override {
    if (gathers_) fail("has an element within its value");
    if (element == "sheetData") in_table_ = true;
    if (element == "extLst") in_extension_ = true;
    if (element == "row") start_row(attributes);
    if (element == "c") start_cell(attributes);
    if (element == "f") has_formula_ = true;
    gathers_ = in_cell_ && (element == "v" || (element == "t" && !in_aid_));
    if (element == "v" || element == "is") {
      if (has_value_) fail("has two values");
      has_value_ = true;
    }
    if (element == "rPh") in_aid_ = true;
    if (element == "mergeCell") add_merged(attributes.text("ref"));
  }

  void end(std::string_view element) override {
    gathers_ = false;
    if (element == "rPh") in_aid_ = false;
    if (element == "sheetData") in_table_ = false;
    if (element == "extLst") in_extension_ = false;
    if (element == "row") in_row_ = false;
    if (element != "c" || !in_cell_) return;
    in_cell_ = false;
    finish_cell();
  }

  /// Refuses rows or cells from an unknown namespace, which would be missing from the record.
  void foreign() override {
    if (in_table_ && !in_extension_) fail("or a cell after it is of an unknown type");
  }

  void text(std::string_view text) override {
    if (!gathers_) return;
    cell_.text += text;
    if (cell_.text.size() > kLongestCell) fail("has more text than a cell may have");
  }

  bool is_done() const override { return done_; }
  std::vector<XlsxMerged> take_merged() { return std::move(merged_); }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({file_}, fmt::format("{}!{} {}; save the workbook again", sheet_,
                                          xlsx_address(cell_.row, cell_.column), message));
  }

  void start_row(const XmlAttributes& attributes) {
    const std::size_t next = row_ + 1;
    row_ = next;
    if (const auto given = attributes.find("r"))
      row_ = whole_number<std::size_t>(*given).value_or(0);
    cell_ = {row_, 1, XlsxKind::number, {}};
    column_ = 0;
    in_row_ = true;
    if (row_ < next || row_ > kMostRows) fail("begins a row that is out of order");
  }

  void start_cell(const XmlAttributes& attributes) {
    Place place{row_, column_ + 1};
    cell_ = {place.row, place.column, XlsxKind::number, {}};
    if (const auto given = attributes.find("r")) place = parsed_address(*given).value_or(Place{});
    if (!in_row_ || in_cell_ || place.row != row_ || place.column <= column_ ||
        place.column > kMostSheetColumns)
      fail("or a cell after it is out of order");
    column_ = place.column;
    cell_.column = place.column;
    type_ = attributes.text("t");
    style_ = whole_number<std::size_t>(attributes.text("s")).value_or(0);
    in_cell_ = true;
    has_formula_ = false;
    has_value_ = false;
  }

  void finish_cell() {
    if (!has_value_ && !has_formula_) return;
    const bool is_numeric = type_.empty() || type_ == "n";
    const bool is_empty = !has_value_ || (is_numeric && cell_.text.empty());
    const bool is_placeholder = is_to_be_computed_ && cell_.text == "0";
    if (has_formula_ && (is_empty || is_placeholder)) {
      cell_.kind = XlsxKind::no_result;
    } else if (is_numeric) {
      if (is_empty) return;
      const bool is_date = style_ < shows_a_date_.size() && shows_a_date_[style_];
      cell_.kind = is_date ? XlsxKind::date : XlsxKind::number;
    } else if (type_ == "s") {
      const auto index = whole_number<std::size_t>(cell_.text);
      if (!index || *index >= texts_.size()) fail("refers to text that the workbook lacks");
      cell_.text = texts_[*index];
      cell_.kind = XlsxKind::text;
    } else if (type_ == "b") {
      cell_.kind = XlsxKind::truth;
    } else if (type_ == "e") {
      cell_.kind = XlsxKind::error;
    } else if (type_ == "d") {
      cell_.kind = XlsxKind::date;
    } else {
      cell_.kind = XlsxKind::text;
    }
    if (!done_) done_ = !take_(cell_);
  }

  void add_merged(std::string_view range) {
    const std::size_t colon = range.find(':');
    if (colon == std::string_view::npos || merged_.size() >= kMostMerged) return;
    const auto first = parsed_address(range.substr(0, colon));
    const auto last = parsed_address(range.substr(colon + 1));
    if (first && last)
      merged_.push_back({std::string(range), first->row, first->column, last->row, last->column});
  }

  std::string file_;
  std::string sheet_;
  const std::vector<std::string>& texts_;
  const std::vector<bool>& shows_a_date_;
  bool is_to_be_computed_;
  const std::function<bool(const XlsxCell&)>& take_;
  bool in_table_ = false;
  bool in_extension_ = false;
  bool in_row_ = false;
  std::size_t row_ = 0;
  std::size_t column_ = 0;
  XlsxCell cell_;
  std::string type_;
  std::size_t style_ = 0;
  bool in_cell_ = false;
  bool in_aid_ = false;
  bool gathers_ = false;
  bool has_formula_ = false;
  bool has_value_ = false;
  bool done_ = false;
  std::vector<XlsxMerged> merged_;
};

std::map<std::string, Relation> relations(const XlsxArchive& archive, const std::string& part) {
  RelationsHandler handler;
  read_xml(archive, part, kMostPartBytes, handler);
  return std::move(handler.relations);
}

/// Finds the part that contains the workbook.
std::string workbook_part(const XlsxArchive& archive) {
  constexpr const char* kRoot = "_rels/.rels";
  if (!archive.has(kRoot))
    throw InputError({archive.name()},
                     "is a ZIP archive, but not an .xlsx workbook; expected one (save a table of "
                     "another program as .xlsx or CSV)");
  for (const auto& [id, relation] : relations(archive, kRoot)) {
    if (relation.kind != "officeDocument") continue;
    const std::string part = resolved("", relation.target);
    if (part.ends_with(".xml")) return part;
    throw InputError({archive.name()},
                     fmt::format("has its workbook in '{}', in another format (.xlsb); save it as "
                                 ".xlsx",
                                 shown(part)));
  }
  throw InputError({archive.name()}, "contains no workbook; expected an .xlsx file of Excel");
}

}  // namespace

std::string xlsx_address(std::size_t row, std::size_t column) {
  std::string letters;
  for (; column > 0; column = (column - 1) / 26)
    letters.insert(letters.begin(), static_cast<char>('A' + (column - 1) % 26));
  return letters + std::to_string(row);
}

XlsxBook::XlsxBook(const std::filesystem::path& path) : archive_(path) {
  const std::string workbook = workbook_part(archive_);
  const auto parts = relations(archive_, relations_of(workbook));
  WorkbookHandler handler;
  read_xml(archive_, workbook, kMostPartBytes, handler);
  is_to_be_computed_ = handler.is_to_be_computed;
  for (const auto& [sheet, id] : handler.sheets) {
    const auto found = parts.find(id);
    if (found == parts.end() || found->second.kind != "worksheet") continue;
    const std::string part = resolved(workbook, found->second.target);
    // A part listed twice would be read as two sheets.
    const auto same = std::find_if(sheets_.begin(), sheets_.end(),
                                   [&](const Sheet& each) { return each.part == part; });
    if (same != sheets_.end())
      throw InputError({name()},
                       fmt::format("stores its worksheets '{}' and '{}' in one part, '{}'; "
                                   "save the workbook again",
                                   shown(same->name), shown(sheet), shown(part)));
    sheets_.push_back({sheet, part});
  }
  if (sheets_.empty())
    throw InputError({name()}, "contains no worksheet; expected one with a table of numbers");
  for (const auto& [id, relation] : parts) {
    if (relation.kind == "sharedStrings") {
      SharedTextsHandler texts(name());
      read_xml(archive_, resolved(workbook, relation.target), 4 * kMostSharedBytes, texts);
      texts_ = std::move(texts.texts);
    }
    if (relation.kind == "styles") {
      StylesHandler styles;
      read_xml(archive_, resolved(workbook, relation.target), kMostPartBytes, styles);
      shows_a_date_ = std::move(styles.shows_a_date);
    }
  }
}

std::vector<XlsxMerged> XlsxBook::read(const Sheet& sheet,
                                       const std::function<bool(const XlsxCell&)>& take) const {
  SheetHandler handler(name(), shown(sheet.name), texts_, shows_a_date_, is_to_be_computed_, take);
  read_xml(archive_, sheet.part, kMostSheetBytes, handler);
  return handler.take_merged();
}

}  // namespace rigcal::datasets
