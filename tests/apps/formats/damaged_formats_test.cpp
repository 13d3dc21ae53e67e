#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/cli_fixture.hpp"
#include "tests/apps/formats/format_fixture.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;
using Catch::StartsWith;

/// A twin with one record in another format, whose file is damaged.
struct Scene {
  Scene(const CommandFolder& of, const RecordFormat& format)
      : folder(of), file("twin/records/sine_bad" + format.extension) {
    REQUIRE(write_twin(folder).exit_code == 0);
    format.write(record_columns_of(folder.read("twin/records/sine_r1.csv")), folder.work() / file);
    folder.write("twin/campaign.toml",
                 replaced(folder.read("twin/campaign.toml"), "records/sine_r1.csv",
                          "records/sine_bad" + format.extension));
    whole = folder.read(file);
    REQUIRE(check(whole).exit_code == 0);
  }

  Outcome check(const std::string& content) const {
    std::filesystem::remove(folder.work() / file);
    folder.write(file, content);
    return folder.run({"check", "twin/campaign.toml"});
  }

  const CommandFolder& folder;
  std::string file;
  std::string whole;
};

/// Checks for one line that names the file and does not blame a bug.
void check_refused(const Scene& scene, const Outcome& outcome) {
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err,
             StartsWith("rigcal: ") && Contains(scene.file + ": ") && !Contains("bug"));
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

RecordFormat format_of(const std::string& name) {
  const auto& all = record_formats();
  return *std::find_if(all.begin(), all.end(),
                       [&](const RecordFormat& format) { return format.name == name; });
}

}  // namespace

TEST_CASE("check: an HDF5 file or a workbook that is cut or changed", "[apps]") {
  const std::string name = GENERATE("hdf5", "xlsx");
  const CommandFolder folder;
  const Scene scene(folder, format_of(name));
  const std::size_t size = scene.whole.size();
  const std::size_t cuts = kSanitized ? 8 : 40;
  for (std::size_t i = 0; i < cuts; ++i) {
    const std::size_t bytes = i * size / cuts;
    CAPTURE(name, bytes, size);
    check_refused(scene, scene.check(scene.whole.substr(0, bytes)));
  }
  // A changed number cannot be detected, but nothing may crash. Descriptions are at the beginning
  // of HDF5 files and at the end of archives.
  const std::size_t changes = kSanitized ? 12 : 80;
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t from_edge = i * std::min<std::size_t>(size, 4096) / changes;
    const std::size_t at = name == "hdf5" ? from_edge : size - 1 - from_edge;
    std::string damaged = scene.whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (i % 2 == 0 ? 0x80 : 0x01));
    const Outcome outcome = scene.check(damaged);
    CAPTURE(name, at, size);
    if (outcome.exit_code == 0) continue;
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("sine_bad") && !Contains("bug"));
  }
}

TEST_CASE("check: a workbook that inflates without end is refused", "[apps]") {
  const CommandFolder folder;
  const Scene scene(folder, format_of("xlsx"));
  auto parts = xlsx_parts({{"Log", sheet_xml({{cell("t_s")}, {cell(0)}})}});
  std::string names = "<sst>";
  for (int i = 0; i < 300; ++i) names += "<si><t>" + std::string(1'000'000, ' ') + "</t></si>";
  parts.back().second = names + "</sst>";
  write_zip(folder.work() / "bomb.xlsx", parts);
  const std::string bomb = folder.read("bomb.xlsx");
  CHECK(bomb.size() < names.size() / 100);
  const Outcome outcome = scene.check(bomb);
  check_refused(scene, outcome);
  CHECK_THAT(outcome.err, Contains("contains more than 64 MB of text"));
}

TEST_CASE("check: a cell that is no number is named with file, sheet and address", "[apps]") {
  const CommandFolder folder;
  const Scene scene(folder, format_of("xlsx"));
  RecordColumns columns = record_columns_of(folder.read("twin/records/sine_r2.csv"));
  XlsxRows rows(1);
  for (const std::string& name : columns.names) rows[0].push_back(cell(name));
  for (int i = 0; i < 20; ++i) {
    rows.emplace_back();
    for (const auto& column : columns.values)
      rows.back().push_back(cell(column[static_cast<std::size_t>(i)]));
  }
  rows[16][1] = raw_cell("<c r=\"@\" t=\"e\"><f>1/0</f><v>#DIV/0!</v></c>");
  write_xlsx(folder.work() / "cells.xlsx", {{"Sheet1", rows}});
  const Outcome outcome = scene.check(folder.read("cells.xlsx"));
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err,
             Contains("sine_bad.xlsx: Sheet1!B17 is the error #DIV/0!; expected a number"));
}

TEST_CASE("check: units in an HDF5 file or a workbook that contradict the campaign", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const std::vector<std::string> names{"time", "setpoint", "stroke", "load"};
  for (const std::string format : {"h5", "xlsx"}) {
    folder.write("campaign.toml", edited(kCampaign, {{"\"t_s\"", "\"time\""},
                                                     {"\"ref_mm\"", "\"setpoint\""},
                                                     {"\"x_mm\"", "\"stroke\""},
                                                     {"\"pl_bar\"", "\"load\""},
                                                     {"sine_*.csv", "sine_1." + format},
                                                     {"square_*.csv", "square_1." + format}}));
    for (const std::string load : {"bar", "psi"}) {
      CAPTURE(format, load);
      const std::vector<std::string> units{"s", "mm", "mm", load};
      for (const std::string record : {"records/sine_1", "records/square_1"}) {
        const RecordColumns columns = record_columns_of(folder.read(record + ".csv"));
        const std::filesystem::path path = folder.work() / (record + "." + format);
        if (format == "h5") {
          const Hdf5Writer file(path);
          for (std::size_t k = 0; k < names.size(); ++k) {
            file.array("/" + names[k], columns.values.at(k));
            file.text("/" + names[k], "units", units[k]);
          }
        } else {
          XlsxRows rows(2);
          for (std::size_t k = 0; k < names.size(); ++k) {
            rows[0].push_back(cell(names[k]));
            rows[1].push_back(cell(units[k]));
          }
          for (std::size_t i = 0; i < columns.values.at(0).size(); ++i) {
            rows.emplace_back();
            for (const auto& column : columns.values) rows.back().push_back(cell(column[i]));
          }
          write_xlsx(path, {{"Log", rows}});
        }
      }
      const Outcome outcome = folder.run({"check", "campaign.toml"});
      CAPTURE(outcome.err);
      CHECK(outcome.exit_code == (load == "bar" ? 0 : 2));
      if (load == "psi")
        CHECK_THAT(outcome.err, Contains("sine_1." + format) && Contains("is in psi") &&
                                    Contains("load_pressure says unit = \"bar\""));
    }
  }
}

TEST_CASE("init: a draft from HDF5 and from a workbook, with their units", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const RecordColumns columns = record_columns_of(folder.read("twin/records/sine_r1.csv"));
  {
    const Hdf5Writer file(folder.work() / "h5/sine_1.h5");
    file.array("/run/time", columns.values.at(0));
    file.array("/run/setpoint", columns.values.at(1));
    file.array("/run/stroke", columns.values.at(2));
    file.text("/run/time", "units", "s");
    file.text("/run/setpoint", "units", "mm");
    file.text("/run/stroke", "unit", "mm");
  }
  REQUIRE(folder.run({"init", "h5", "--out", "from-h5"}).exit_code == 0);
  const std::string from_h5 = folder.read("from-h5/campaign.toml");
  CHECK_THAT(from_h5, Contains("time = { column = \"/run/time\", unit = \"s\" }") &&
                          Contains("reference = { column = \"/run/setpoint\", unit = \"mm\" }") &&
                          Contains("position = { column = \"/run/stroke\", unit = \"mm\" }") &&
                          Contains("\"../h5/sine_1.h5\"") && Contains("waveform = \"sine\""));
  XlsxRows rows{{cell("time"), cell("setpoint"), cell("stroke")},
                {cell("s"), cell("[mm]"), cell("mm")}};
  for (std::size_t i = 0; i < columns.values.at(0).size(); ++i)
    rows.push_back(
        {cell(columns.values[0][i]), cell(columns.values[1][i]), cell(columns.values[2][i])});
  write_xlsx(folder.work() / "book/sine_1.xlsx", {{"Log", rows}});
  REQUIRE(folder.run({"init", "book", "--out", "from-book"}).exit_code == 0);
  CHECK(replaced(replaced(replaced(replaced(folder.read("from-book/campaign.toml"), "\"time\"",
                                            "\"/run/time\""),
                                   "\"setpoint\"", "\"/run/setpoint\""),
                          "\"stroke\"", "\"/run/stroke\""),
                 "../book/sine_1.xlsx", "../h5/sine_1.h5") == from_h5);
  const Outcome none = folder.run({"init", "twin", "--out", "none"});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.err, Contains("this folder has no .csv, "));
}

}  // namespace rigcal::test
