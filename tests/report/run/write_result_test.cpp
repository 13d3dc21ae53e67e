#include "report/run/write_result.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "common/file.hpp"
#include "report/document/render_terminal.hpp"
#include "tests/report/run/made_fit.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("written result: the JSON comes last, and names the others", "[report][run]") {
  test::MadeFit fitted;
  const auto out = fitted.folder / "out";
  HeldFolder held(out, {"fit"});
  const WrittenResult written = write_result(held, 1, fitted.result());
  REQUIRE(written.files.size() == 10);
  CHECK(written.files.back() == "fit.json");
  CHECK(written.files[8] == "report.html");
  CHECK(written.json == test::text_of(out / "fit.json"));
  const Json fit = Json::parse(written.json);
  REQUIRE(fit["provenance"]["files"].size() == 8);
  for (const Json& file : fit["provenance"]["files"])
    CHECK(sha256_of_file(out / file["path"].get<std::string>()) ==
          file["sha256"].get<std::string>());
  // The terminal shows the same as the page.
  REQUIRE(written.documents.size() == 1);
  CHECK(doc::render_terminal(written.documents[0], {}) ==
        doc::render_terminal(document_of(fitted.result()), {}));
}

TEST_CASE("written result: a failed fit leaves no fitted campaign of an earlier one",
          "[report][run]") {
  test::MadeFit fitted;
  const auto out = fitted.folder / "out";
  HeldFolder held(out, {"fit"});
  write_result(held, 1, fitted.result());
  REQUIRE(std::filesystem::exists(out / "fitted.toml"));
  fitted.fit = {};
  fitted.fit.message = "no start could be simulated";
  write_result(held, 1, fitted.result());
  CHECK_FALSE(std::filesystem::exists(out / "fitted.toml"));
  CHECK(test::text_of(out / "fit.json").find("no start could be simulated") != std::string::npos);
  CHECK(std::filesystem::exists(out / "residuals" / "sine_1Hz.csv"));
}

}  // namespace
}  // namespace rigcal::report
