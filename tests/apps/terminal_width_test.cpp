#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>

#include "report/text/text_table.hpp"
#include "tests/apps/cli_fixture.hpp"

using Catch::Contains;
using rigcal::report::text_width;
using rigcal::test::CommandFolder;
using rigcal::test::write_twin;

namespace {

/// Sets the terminal width that commands see while the object exists.
class Columns {
 public:
  explicit Columns(const char* columns) { ::setenv("COLUMNS", columns, 1); }
  ~Columns() { ::unsetenv("COLUMNS"); }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
};

std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, text_width(line));
  return widest;
}

std::string line_of(const std::string& text, std::size_t number) {
  std::istringstream lines(text);
  std::string line;
  for (std::size_t i = 0; i < number; ++i) std::getline(lines, line);
  return line;
}

}  // namespace

TEST_CASE("rigcal: every verb fits on 80 columns", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const Columns columns("80");
  const std::string campaign = "twin/campaign.toml";
  for (const CommandFolder::Arguments& arguments : std::vector<CommandFolder::Arguments>{
           {"params"},
           {"check", campaign},
           {"average", campaign, "--out", "average"},
           {"simulate", campaign, "--out", "simulation"},
           {"fit", campaign, "--out", "fit"},
           {"validate", campaign, "--fit", "fit/fit.json", "--out", "validation"},
           {"diagnose", campaign, "--fit", "fit/fit.json", "--out", "diagnosis"},
           {"parity", campaign, "--fit", "fit/fit.json", "--out", "parity"},
           {"plan", campaign, "--fit", "fit/fit.json", "--out", "plan"},
           {"export", "fmu", campaign, "--fit", "fit/fit.json", "--out", "export"},
           {"leak-table", campaign, "--signals", "sine@2Hz@5mm,square@1Hz@4mm", "--targets", "5,10",
            "--out", "table"},
           {"batch", "twin", "--out", "batch"},
           {"compare", "fit", "validation", "--out", "comparison"},
           {"synthesize", "truth.toml", "--seed", "4", "--out", "other"}}) {
    CAPTURE(arguments.front());
    const auto outcome = folder.run(arguments);
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.exit_code <= 1);
    CHECK(outcome.out.size() > 20);
    CHECK(widest_line(outcome.out) <= 80);
  }
}

TEST_CASE("fit: the page that is signed, and all else only if asked for", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string out = folder.run({"fit", "twin/campaign.toml", "--out", "fit"}).out;
  CHECK_THAT(line_of(out, 1), Catch::StartsWith("PASS: ") && Contains("of the permitted error"));
  CHECK_THAT(out, Contains("\nResult: calibrated values") && Contains("Decision rule: ") &&
                      Contains("\nWhy this verdict\n") && Contains("campaign are synthetic\n") &&
                      Contains("\n-v for more: Assessment, ") && !Contains("Plain std. error"));
  CHECK_THAT(out, Contains("\nfiles: fit/fit.json "));
  const std::string all =
      folder.run({"fit", "twin/campaign.toml", "--out", "fit", "--verbose"}).out;
  CHECK_THAT(all, Catch::StartsWith("PASS: ") && Contains("Plain std. error") &&
                      Contains("Known values") && Contains("Gain ratio") &&
                      !Contains("-v for more"));
}

TEST_CASE("average: the terminal tells noise floor and offsets", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_twin(folder).exit_code == 0);
  const std::string out = folder.run({"average", "twin/campaign.toml", "--out", "average"}).out;
  CHECK_THAT(out, Contains("Floor of rho2") && Contains("Floor of the error, %") &&
                      Contains("Offsets") && Contains("Outliers"));
  CHECK_THAT(out, Contains("\nsine ") && Contains("position") && Contains(" ms "));
}

TEST_CASE("rigcal: COLUMNS that is no number of columns is passed over", "[apps]") {
  const CommandFolder folder;
  const std::string wide = folder.run({"params"}).out;
  for (const char* columns : {"", "wide", "3", "-80", "80x"}) {
    const Columns told(columns);
    CHECK(folder.run({"params"}).out == wide);
  }
}
