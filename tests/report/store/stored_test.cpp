#include "report/store/stored.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <memory>

#include "common/error.hpp"
#include "report/store/result_files.hpp"
#include "tests/report/stored_fixture.hpp"

using Catch::Contains;
using namespace rigcal::report;

namespace {

/// Reads only these JSON files, and records which other files were requested.
struct StoredFiles {
  std::map<std::string, Json> json;
  std::vector<std::string> others;

  ReadFile reader() {
    return rigcal::test::reading(
        [this](const std::filesystem::path& path) -> std::optional<std::string> {
          const auto found = json.find(path.string());
          if (found != json.end()) return found->second.dump();
          others.push_back(path.string());
          return std::nullopt;
        });
  }
};

}  // namespace

TEST_CASE("stored: the id of a condition is no way to other folders", "[report]") {
  StoredFiles files;
  files.json["residual_tests.json"] = Json::parse(rigcal::test::kNoCurves);
  files.json["fit.json"] = rigcal::test::stored_result();
  load_calibration(files.reader(), "folder", 1);
  CHECK(std::count(files.others.begin(), files.others.end(), "residuals/sine.csv") == 1);
  for (const char* id : {"../../secret", "..", "/etc/passwd", "a/b", ""}) {
    files.json["fit.json"]["conditions"][0]["id"] = id;
    files.others.clear();
    CHECK_THROWS_WITH(load_calibration(files.reader(), "folder", 1),
                      Contains("folder/fit.json") && Contains("key 'id' of a condition") &&
                          Contains("expected an id of letters"));
    for (const std::string& other : files.others) CHECK_THAT(other, !Contains("residuals"));
  }
}

TEST_CASE("stored: the files of another run are refused", "[report]") {
  StoredFiles files;
  Json& fit = files.json["fit.json"] = rigcal::test::stored_result();
  Json& curves = files.json["residual_tests.json"] = Json::parse(rigcal::test::kNoCurves);
  StoredProvenance provenance;
  std::vector<ResultFile> written{{"residual_tests.json", curves.dump()}};
  name_files(written, provenance);
  fit["provenance"]["files"] = json_of(provenance)["files"];
  CHECK(fit["provenance"]["files"][0]["path"] == "residual_tests.json");
  CHECK_NOTHROW(load_calibration(files.reader(), "folder", 1));
  curves["of"] = "rigcal.validation/1";
  CHECK_THROWS_WITH(load_calibration(files.reader(), "folder", 1),
                    Contains("folder/residual_tests.json") &&
                        Contains("is not the file that fit.json was written with"));
  fit["provenance"].erase("files");  // as in a file from an earlier version
  CHECK_NOTHROW(load_calibration(files.reader(), "folder", 1));
}

TEST_CASE("stored: what this run has made is not read back", "[report]") {
  StoredFiles disk;
  disk.json["residual_tests.json"] = Json::parse(rigcal::test::kNoCurves);
  const auto fit = as<StoredFit>(rigcal::test::stored_result(), "", "fit.json");
  std::vector<ResultFile> files{json_file("fit.json", fit)};
  files[0].content = "no JSON";
  int asked = 0;
  const ReadFile tables = [&](const std::filesystem::path& path) {
    if (path != "residuals/sine.csv") return std::shared_ptr<const ResultFile>();
    ++asked;
    return std::make_shared<const ResultFile>(table_file(path, {{"time_s"}, {{0.0, 1.0}}}));
  };
  const auto stored = std::get<Calibration>(
      load_calibration(either(files_in(files), either(tables, disk.reader())), "folder", 1));
  CHECK(json_of(stored.result) == json_of(fit));
  CHECK(asked == 0);
  CHECK(stored.series(0)->names == std::vector<std::string>{"time_s"});
  CHECK(asked == 1);
  for (const std::string& other : disk.others) CHECK_THAT(other, !Contains("residuals"));
  const auto none =
      std::get<Calibration>(load_calibration(either(files_in(files), disk.reader()), "folder", 1));
  CHECK(none.series(0)->columns.empty());
}

TEST_CASE("stored: the files of this run need not be hashed again", "[report]") {
  StoredProvenance provenance;
  std::vector<ResultFile> written{table_file("levels/a.csv", {{"time_s"}, {{0.0}}})};
  name_files(written, provenance);
  written[0].content = "time_s\n1\n";
  const ReadFile own = files_of_run(files_in(written), provenance, "folder", "leak_table.json");
  CHECK(table_in(own, "folder", "levels/a.csv")->columns[0] == std::vector{0.0});
  CHECK(table_in(own, "folder", "levels/b.csv") == nullptr);
  written[0] = {"levels/a.csv", "time_s\n1\n"};  // as if it was read from the folder
  CHECK_THROWS_WITH(table_in(own, "folder", "levels/a.csv"),
                    Contains("is not the file that leak_table.json was written with"));
}

TEST_CASE("stored: nor is the condition of a parity record", "[report]") {
  StoredFiles files;
  Json& parity = files.json["parity.json"];
  StoredParity stored;
  stored.records.emplace_back().condition = "sine";
  parity = json_of(stored);
  load_parity(files.reader(), "folder");
  CHECK(files.others == std::vector<std::string>{"parity/sine.csv"});
  parity["records"][0]["condition"] = "../sine";
  CHECK_THROWS_AS(load_parity(files.reader(), "folder"), rigcal::InputError);
}

TEST_CASE("stored: what a diagnosis says of a leak has another kind", "[report]") {
  StoredFiles files;
  StoredDiagnosis stored;
  rigcal::diagnosis::RecordDiagnosis& record = stored.found.records.emplace_back();
  record.condition = "sine";
  record.leak.class_ = rigcal::datasets::LeakClass::slight;
  record.leak.ci95 = {0.1, 0.2};
  Json& diagnosis = files.json["diagnosis.json"] = json_of(stored);
  const StoredDiagnosis read = load_diagnosis(files.reader(), "folder");
  CHECK(json_of(read) == diagnosis);
  CHECK(read.found.records[0].leak.ci95->high == 0.2);
  diagnosis["records"][0]["class"] = "hardly any";
  CHECK_THROWS_WITH(load_diagnosis(files.reader(), "folder"),
                    Contains("key 'records[0].class': found \"hardly any\"") &&
                        Contains("expected one of normal, slight"));
  diagnosis = json_of(stored);
  diagnosis["class_limits"] = json_of(std::vector{
      rigcal::diagnosis::ClassLimit{"sine", 1.0, std::nullopt, {0.1, 0.2}, {std::nullopt}}});
  CHECK_THROWS_WITH(load_diagnosis(files.reader(), "folder"),
                    Contains("class_limits: found 1 entries, expected 2"));
}

TEST_CASE("stored: lists that belong together are of the same length", "[report]") {
  StoredFiles files;
  files.json["fit.json"] = rigcal::test::stored_result();
  Json& all = files.json["residual_tests.json"] = Json::parse(rigcal::test::kNoCurves);
  all["conditions"]["sine"]["position"] = Json::parse(R"({
    "autocorrelation": {"first_lag_s": 0, "lag_step_s": 0.1, "band": 0.2, "values": [1, 0.5]},
    "cross_correlation": null,
    "periodogram": {"frequency_hz": [1, 2], "density": [3, 4]},
    "normality": {"normal_quantile": [-1, 1], "residual_quantile": [-1, 1]}})");
  CHECK_NOTHROW(load_calibration(files.reader(), "folder", 1));
  const Json whole = all;
  for (const char* list : {"/periodogram/density", "/periodogram/frequency_hz",
                           "/normality/residual_quantile", "/normality/normal_quantile"}) {
    for (const Json& other : {Json::array(), Json{1.0}, Json{1.0, 2.0, 3.0}}) {
      all = whole;
      all["conditions"]["sine"]["position"][Json::json_pointer(list)] = other;
      CHECK_THROWS_WITH(load_calibration(files.reader(), "folder", 1),
                        Contains("folder/residual_tests.json") && Contains("position") &&
                            Contains("sine") && Contains("entries"));
    }
  }
}
