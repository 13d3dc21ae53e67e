#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/two_chamber_fixture.hpp"
#include "tests/datasets/mat_fixture.hpp"

using namespace rigcal::test;
using nlohmann::json;

namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) result.push_back(cell);
  return result;
}

/// The columns of a CSV file as variables of a MAT file.
void as_mat(const CommandFolder& folder, const std::string& csv, const std::string& mat,
            MatFormat format) {
  std::istringstream text(folder.read(csv));
  std::string line;
  while (std::getline(text, line) && line.starts_with('#')) {
  }
  const std::vector<std::string> names = cells(line);
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(text, line)) {
    const std::vector<std::string> row = cells(line);
    REQUIRE(row.size() == names.size());
    for (std::size_t k = 0; k < row.size(); ++k)
      columns[k].push_back(std::strtod(row[k].c_str(), nullptr));
  }
  std::vector<matvar_t*> variables;
  for (std::size_t k = 0; k < names.size(); ++k)
    variables.push_back(mat_array(names[k], columns[k]));
  write_mat(folder.work() / mat, format, variables);
}

std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to);
  return text;
}

/// What a fit found, without where and when.
json found(const CommandFolder& folder, const std::string& out) {
  json result = json::parse(folder.read(out + "/fit.json"));
  result.erase("wall_seconds");
  result.erase("provenance");
  return result;
}

}  // namespace

TEST_CASE("fit: the same campaign as CSV and as MAT gives the same bits", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_two_chamber_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "csv", "--quiet"}).exit_code == 0);
  const json from_csv = found(folder, "csv");
  REQUIRE(from_csv.at("status") == "converged");
  REQUIRE(from_csv.at("parameters").size() > 10);
  const std::string campaign = folder.read("twin/campaign.toml");
  for (const auto& [name, format] : std::map<std::string, MatFormat>{
           {"v6", MatFormat::v6}, {"v7", MatFormat::v7}, {"v73", MatFormat::v73}}) {
    CAPTURE(name);
    for (const std::string& file : folder.files()) {
      if (file.starts_with("twin/records/"))
        as_mat(folder, file, name + "/" + replaced_all(file.substr(5), ".csv", ".mat"), format);
    }
    folder.write(name + "/campaign.toml", replaced_all(campaign, ".csv", ".mat"));
    const Outcome fitted =
        folder.run({"fit", name + "/campaign.toml", "--out", name + "-out", "--quiet"});
    CHECK(fitted.err.empty());
    REQUIRE(fitted.exit_code == 0);
    CHECK(found(folder, name + "-out") == from_csv);
    CHECK(folder.read(name + "-out/residuals/square.csv") ==
          folder.read("csv/residuals/square.csv"));
  }
}
