#include "report/store/manifest.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>

#include "common/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::report {
namespace {

using test::TemporaryFolder;

std::set<std::string> found(const TemporaryFolder& folder) {
  std::set<std::string> paths;
  for (const ManifestFile& file : rigcal_files(folder.path())) {
    CHECK(file.sha256 == sha256_of_file(folder / file.path));
    paths.insert(file.path);
  }
  return paths;
}

std::string result(const std::string& schema, const std::string& files) {
  return R"({"status": "done", "schema": ")" + schema +
         R"(", "provenance": {"version": "0.1.0", "revision": "r", "machine": "m", "command": "c",
         "seed": 1, "options": {}, "inputs": [])" +
         files + "}}";
}

std::string named(const std::string& path, const std::string& text) {
  return R"({"path": ")" + path + R"(", "sha256": ")" + sha256_of_text(text) + "\"}";
}

TEST_CASE("manifest: results of earlier versions are known by hash, schema and head", "[report]") {
  const TemporaryFolder folder;
  folder.write("fit.json",
               result("rigcal.fit/1", R"(, "files": [)" + named("residuals/a.csv", "x") + ", " +
                                          named("fitted.toml", "x") + "]"));
  // A fit and a validation both have a file of this name; the later result wrote it.
  folder.write("validation.json", result("rigcal.validation/1",
                                         R"(, "files": [)" + named("residuals/a.csv", "y") + "]"));
  folder.write("residuals/a.csv", "y");
  folder.write("fitted.toml", "# Written by rigcal fit, and edited");  // its hash differs
  folder.write("average.json", result("rigcal.average/1", ""));        // it does not list any files
  folder.write("averaged/a.csv", "time_s,position_m_mean,position_m_sd,position_m_count\n0,1,,1\n");
  folder.write("averaged/b.csv", "t,x_mean,y\n");
  folder.write("plan.json", result("rigcal.fit/1", ""));
  folder.write("parity.json", R"({"schema": "rigcal.parity/1"})");
  folder.write("batch.json", "no JSON");
  folder.write("truth.json", "{\n  \"schema\": \"rigcal.truth/1\"\n}");
  folder.write("campaign.toml", "# synthetic: made by rigcal synthesize, seed 1\n");
  folder.write("records/a_r1.csv", "# synthetic: made by rigcal synthesize, seed 1\nt,x\n");
  folder.write("records/a_r2.csv", "t,x\n");
  folder.write("a.csv", "time_s,reference_m,position_m,work_flow_m3_per_s\n");
  folder.write("b.csv", "time_s,position_m\n");
  folder.write("report.html", "<!doctype html>\n<html lang=\"en\">\n<p class=\"kind\">Report · x");
  folder.write("below/fit.json", result("rigcal.fit/1", ""));
  folder.write("elsewhere/c.csv", "time_s,measured_position_m\n");
  std::filesystem::create_directory_symlink("elsewhere", folder / "overlay");
  CHECK(found(folder) == std::set<std::string>{"fit.json", "validation.json", "residuals/a.csv",
                                               "average.json", "averaged/a.csv", "truth.json",
                                               "records/a_r1.csv", "a.csv", "report.html"});
}

TEST_CASE("manifest: where there is one, nothing is guessed", "[report]") {
  const TemporaryFolder folder;
  folder.write("a.csv", "time_s,reference_m,position_m,work_flow_m3_per_s\n");
  CHECK(manifest_files(folder.path()).size() == 1);
  folder.write(kManifestFile, manifest_text({{"b.csv", "0", "simulate"}}));
  const auto files = manifest_files(folder.path());
  REQUIRE(files.size() == 1);
  CHECK(files.front().path == "b.csv");
  CHECK(files.front().verb == "simulate");
}

}  // namespace
}  // namespace rigcal::report
