#include "report/run/write_result.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "common/file.hpp"
#include "tests/report/run/made_fit.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("written result: the JSON comes last, and names the others", "[report][run]") {
  test::MadeFit fitted;
  StoredFit fit = stored(fitted.result());
  HeldFolder held(fitted.folder / "out", {"fit"});
  const auto files = write_result(held, 1, fitted.result(), fit);
  REQUIRE(files.size() == 10);
  CHECK(files.back() == "fit.json");
  CHECK(files[8] == "report.html");
  REQUIRE(fit.provenance.files->size() == 8);
  for (const InputFile& file : *fit.provenance.files)
    CHECK(sha256_of_file(fitted.folder / "out" / file.path) == file.sha256);
}

TEST_CASE("written result: a failed fit leaves no fitted campaign of an earlier one",
          "[report][run]") {
  test::MadeFit fitted;
  StoredFit fit = stored(fitted.result());
  const auto out = fitted.folder / "out";
  HeldFolder held(out, {"fit"});
  write_result(held, 1, fitted.result(), fit);
  REQUIRE(std::filesystem::exists(out / "fitted.toml"));
  fitted.fit = {};
  fitted.fit.message = "no start could be simulated";
  fit = stored(fitted.result());
  write_result(held, 1, fitted.result(), fit);
  CHECK_FALSE(std::filesystem::exists(out / "fitted.toml"));
  CHECK(test::text_of(out / "fit.json").find("no start could be simulated") != std::string::npos);
  CHECK(std::filesystem::exists(out / "residuals" / "sine_1Hz.csv"));
}

}  // namespace
}  // namespace rigcal::report
