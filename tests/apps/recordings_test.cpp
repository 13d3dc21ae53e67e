#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/cli_fixture.hpp"

using namespace rigcal::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// Fields in the lines of a CSV text. The first line is the comment "# synthetic", the second the
/// header.
using Rows = std::vector<std::vector<std::string>>;

Rows rows_of(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

std::string text_of_rows(const Rows& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + row[k];
    text += "\n";
  }
  return text;
}

/// A twin whose recordings a test changes.
class Twin {
 public:
  Twin() { REQUIRE(write_twin(folder).exit_code == 0); }

  /// Changes the value in each row of a column, in all repeats of a condition.
  template <typename Function>
  void change(const std::string& condition, int column, Function value) const {
    for (const int repeat : {1, 2, 3}) {
      Rows rows = rows_of(read(condition, repeat));
      for (std::size_t i = 2; i < rows.size(); ++i) {
        std::string& field = rows[i].at(static_cast<std::size_t>(column));
        std::ostringstream text;
        text.precision(17);
        text << value(i, std::stod(field));
        field = text.str();
      }
      write(condition, repeat, text_of_rows(rows));
    }
  }

  std::string name(const std::string& condition, int repeat) const {
    return "twin/records/" + condition + "_r" + std::to_string(repeat) + ".csv";
  }
  std::string read(const std::string& condition, int repeat) const {
    return folder.read(name(condition, repeat));
  }
  void write(const std::string& condition, int repeat, const std::string& text) const {
    folder.write(name(condition, repeat), text);
  }

  Outcome run(const std::string& verb, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {verb, "twin/campaign.toml"});
    return folder.run(more);
  }

  CommandFolder folder;
};

int column_of(const Twin& twin, const std::string& name) {
  const auto header = rows_of(twin.read("sine", 1)).at(1);
  return static_cast<int>(std::find(header.begin(), header.end(), name) - header.begin());
}

bool holds(const json& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const json& text) {
    return text.get<std::string>().find(part) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("recordings: a twin gives no cause for doubt", "[apps]") {
  const Twin twin;
  CHECK_THAT(twin.run("check").out, !Contains("warning"));
}

TEST_CASE("recordings: a clipped sensor is told wherever its record is used", "[apps]") {
  const Twin twin;
  const int position = column_of(twin, "x_mm");
  twin.change("sine", position, [](std::size_t, double x) { return std::min(x, 3.0); });
  const std::string words = "position: stays at exactly its highest value";
  CHECK_THAT(twin.run("check").out, Contains("  warning: " + words));
  CHECK_THAT(twin.run("average", {"--out", "a"}).out, Contains(words));

  const Outcome fit = twin.run("fit", {"--out", "f"});
  CHECK_THAT(fit.out + fit.err, Contains("warning: recording of sine: " + words));
  const json result = json::parse(twin.folder.read("f/fit.json"));
  CHECK(holds(result["warnings"], "recording of sine: " + words));
  for (const json& condition : result["conditions"])
    CHECK(holds(condition["warnings"], words) == (condition["id"] == "sine"));
  CHECK_THAT(twin.folder.read("f/report.html"), Contains("<li>Recording: " + words));

  const Outcome validation = twin.run("validate", {"--fit", "f/fit.json", "--out", "v"});
  CHECK_THAT(validation.out + validation.err, Contains("recording of sine: " + words));
  CHECK(holds(json::parse(twin.folder.read("v/validation.json"))["warnings"], words));

  twin.run("diagnose", {"--fit", "f/fit.json", "--out", "d"});
  const json diagnosis = json::parse(twin.folder.read("d/diagnosis.json"));
  CHECK((holds(diagnosis["warnings"], words) ||
         std::any_of(diagnosis["records"].begin(), diagnosis["records"].end(),
                     [&](const json& record) { return holds(record["warnings"], words); })));
}

TEST_CASE("recordings: a sensor that stands still for a while", "[apps]") {
  const Twin twin;
  const int position = column_of(twin, "x_mm");
  twin.change("sine", position,
              [](std::size_t i, double x) { return i > 100 && i < 150 ? 1.25 : x; });
  CHECK_THAT(twin.run("check").out,
             Contains("position: does not change while the drive does") && Contains("0.00125 m"));
}

TEST_CASE("recordings: all repeats of a condition end half way", "[apps]") {
  const Twin twin;
  for (const int repeat : {1, 2, 3}) {
    Rows rows = rows_of(twin.read("sine", repeat));
    rows.resize(201);
    twin.write("sine", repeat, text_of_rows(rows));
  }
  CHECK_THAT(twin.run("check").out, !Contains("warning"));  // the intended duration is unknown
  const std::string campaign = twin.folder.read("twin/campaign.toml");
  twin.folder.write("twin/campaign.toml",
                    replaced(campaign, "id = \"sine\"", "id = \"sine\"\nduration = \"2 s\""));
  CHECK_THAT(twin.run("check").out, Contains("ends after 0.99 s of the 2 s"));
  CHECK_THAT(twin.run("check", {"--json"}).out, Contains("ends after 0.99 s of the 2 s"));
  CHECK_THAT(twin.run("average", {"--out", "a"}).out, Contains("ends after 0.99 s of the 2 s"));
}

TEST_CASE("recordings: a file that was cut within its last number", "[apps]") {
  const Twin twin;
  Rows rows = rows_of(twin.read("sine", 1));
  rows.back().back() = "1";
  std::string text = text_of_rows(rows);
  text.pop_back();
  twin.write("sine", 1, text);
  CHECK_THAT(twin.run("check").out, Contains("sine_r1.csv:" + std::to_string(rows.size())) &&
                                        Contains("ends without a newline"));
}

TEST_CASE("recordings: one recording given twice", "[apps]") {
  const Twin twin;
  twin.write("sine", 3, twin.read("sine", 1));
  const std::string out = twin.run("check").out;
  CHECK_THAT(out,
             Contains("sine_r1.csv and records/sine_r3.csv are identical") && !Contains("lies"));
}

TEST_CASE("recordings: a NUL in a quantity is refused", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder, {{"mass = \"60 kg\"", "mass = \"60 kg\\u0000x\""}});
  const Outcome outcome = folder.run({"check", "campaign.toml"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("campaign.toml:7:") && Contains("mass") &&
                              Contains("'60 kg?x' contains a control character"));
}

TEST_CASE("recordings: a text that a spreadsheet would run stays text", "[apps]") {
  const CommandFolder folder;
  const std::string formula = "=cmd|' /C calc'!A0";
  write_campaign(folder, {{"[leak_level.\"none\"]", "[leak_level.\"" + formula + "\"]"},
                          {"leak_level = \"none\"\nuse = \"fit\"",
                           "leak_level = \"" + formula + "\"\nuse = \"fit\""},
                          {"leak_level = \"none\"\nuse = \"validate\"",
                           "leak_level = \"" + formula + "\"\nuse = \"validate\""}});
  const Outcome outcome = folder.run({"validate", "campaign.toml", "--out", "v", "--quiet"});
  CAPTURE(outcome.err);
  const std::string scores = folder.read("v/scorecard.csv");
  CHECK_THAT(scores, Contains(",'" + formula) && !Contains("," + formula));
}

TEST_CASE("recordings: samples that are missing in one repeat", "[apps]") {
  const Twin twin;
  // Changes all repeats, because repeats with different times would be rejected first.
  for (const int repeat : {1, 2, 3}) {
    Rows rows = rows_of(twin.read("sine", repeat));
    rows.erase(rows.begin() + 150, rows.begin() + 250);
    twin.write("sine", repeat, text_of_rows(rows));
  }
  const std::string words = "samples are missing before sample 149";
  const Outcome check = twin.run("check");
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out, Contains("warning: ") && Contains(words));
  CHECK(twin.run("average", {"--out", "a"}).exit_code == 0);
  for (const char* verb : {"fit", "validate", "plan"}) {
    CAPTURE(verb);
    const Outcome outcome = twin.run(verb, {"--out", verb});
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("condition \"sine\": ") && Contains("sine_r1.csv") &&
                                Contains(words) && Contains("two windows"));
  }
  const std::string campaign = twin.folder.read("twin/campaign.toml");
  twin.folder.write(
      "twin/campaign.toml",
      replaced(campaign, "id = \"sine\"",
               "id = \"sine\"\nwindow = [[\"0 s\", \"0.73 s\"], [\"1.25 s\", \"2 s\"]]"));
  CHECK_THAT(twin.run("check").out, !Contains(words));
  CHECK(twin.run("fit", {"--out", "f"}).exit_code == 0);
}

TEST_CASE("recordings: a time in ms that is read as s, and a position in other units", "[apps]") {
  const Twin twin;
  const int time = column_of(twin, "t_s");
  twin.change("sine", time, [](std::size_t, double t) { return 1e3 * t; });
  CHECK_THAT(twin.run("check").out, Contains("is its time in ms?"));
  const Twin other;
  other.change("sine", column_of(other, "x_mm"), [](std::size_t, double x) { return 1e3 * x; });
  CHECK_THAT(other.run("check").out, Contains("m of travel") && Contains("is the unit"));
}
