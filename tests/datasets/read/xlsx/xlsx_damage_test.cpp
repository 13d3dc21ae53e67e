#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/read/xlsx/load_xlsx.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/datasets/xlsx_fixture.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using datasets::load_xlsx_record;

Ending xlsx_ending(const fs::path& path) {
  return ending_of(path, [&] {
    datasets::xlsx_record_columns(path);
    return all_finite(load_xlsx_record(path, {{"t", "x"}, "t"}).columns);
  });
}

std::string small_xlsx(const TemporaryFolder& folder, bool squeezed) {
  const std::string sheet = sheet_xml({{cell("t"), cell("x")},
                                       {cell("s"), cell("mm")},
                                       {cell(0), cell(1)},
                                       {cell(0.5), cell(2)},
                                       {cell(1), cell(3)}});
  write_zip(folder / "small.xlsx", xlsx_parts({{"Log", sheet}}), squeezed);
  return text_of(folder / "small.xlsx");
}

/// Writes a workbook with this first sheet.
void write_bomb(const fs::path& path, const std::string& sheet) {
  write_zip(path, xlsx_parts({{"Log", sheet}}));
}

}  // namespace

TEST_CASE("damaged XLSX: a changed byte gives numbers or is refused", "[datasets]") {
  const bool squeezed = GENERATE(true, false);
  const TemporaryFolder folder;
  const std::string whole = small_xlsx(folder, squeezed);
  REQUIRE(xlsx_ending(folder / "small.xlsx") == Ending::values);
  const Endings count =
      damage(folder, "damaged.xlsx", whole, kSanitized ? 67 : 13, {0x80, 0x01}, xlsx_ending);
  // Names, sizes and dates in the directory of the archive have no checksum.
  CHECK(count.refused > 0);
}

TEST_CASE("damaged XLSX: cut anywhere, it is refused", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_xlsx(folder, true);
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += kSanitized ? 199 : 29) {
    CAPTURE(bytes, whole.size());
    CHECK(xlsx_ending(folder.write("cut.xlsx", whole.substr(0, bytes))) == Ending::refused);
  }
}

TEST_CASE("damaged XLSX: what inflates without end is refused", "[datasets]") {
  const TemporaryFolder folder;
  const auto bomb = folder / "bomb.xlsx";
  const std::string head = sheet_xml({{cell("t"), cell("x")}, {cell(0), cell(1)}});
  const std::string blanks(std::size_t{1} << 20, ' ');
  std::string text = head;
  // A cell may not have more text than this, but 64 MB of blanks outside cells are accepted.
  text.replace(text.find("<v>0</v>"), 8, "<v>" + std::string(300'000, '1') + "</v>");
  write_bomb(bomb, text);
  CHECK_THROWS_WITH(load_xlsx_record(bomb, {{"t", "x"}, "t"}),
                    Catch::Contains("Log!A2 has more text than a cell may have"));
  text = head;
  std::string names = "<sst>";
  for (int i = 0; i < 70; ++i) names += "<si><t>" + blanks + "</t></si>";
  auto parts = xlsx_parts({{"Log", text}});
  parts.back().second = names + "</sst>";
  write_zip(bomb, parts);
  CHECK_THROWS_WITH(load_xlsx_record(bomb, {{"t", "x"}, "t"}),
                    Catch::Contains("contains more than 64 MB of text"));
  const auto require_refused_styles = [&](const std::string& styles, const std::string& message) {
    parts = xlsx_parts({{"Log", text}});
    parts.at(parts.size() - 2).second = styles;
    write_zip(bomb, parts);
    CHECK_THROWS_WITH(load_xlsx_record(bomb, {{"t", "x"}, "t"}), Catch::Contains(message));
  };
  // Expat would reread a tag from its beginning for every block.
  std::string attribute = "<styleSheet a=\"";
  std::string comment = "<styleSheet><!--";
  for (int i = 0; i < 70; ++i) {
    attribute += blanks;
    comment += blanks;
  }
  require_refused_styles(attribute + "\"/>",
                         "'xl/styles.xml' has a tag or comment of more than 1 MB");
  require_refused_styles(comment + "--></styleSheet>", "has a tag or comment of more than 1 MB");
  std::string many = "<styleSheet>";
  for (int i = 0; i < 140; ++i) many += "<a b=\"" + blanks.substr(blanks.size() / 2) + "\"/>";
  require_refused_styles(many + "</styleSheet>", "'xl/styles.xml' inflates to more than 64 MB");
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  CHECK(children.ru_maxrss / 1024 < (kSanitized ? 4096 : 1024));
}

}  // namespace rigcal::test
