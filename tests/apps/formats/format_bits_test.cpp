#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/formats/format_fixture.hpp"
#include "tests/apps/two_chamber_fixture.hpp"

using namespace rigcal::test;
using nlohmann::json;

namespace {

std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to);
  return text;
}

/// Returns the results of a fit without paths, times and hashes of inputs.
json found(const CommandFolder& folder, const std::string& out) {
  json result = json::parse(folder.read(out + "/fit.json"));
  result.erase("wall_seconds");
  result.erase("provenance");
  for (json& condition : result["conditions"]) condition.erase("record_sha256");
  return result;
}

/// Writes the campaign of `twin/` with its records in another format to a folder named after the
/// format.
void write_as(const CommandFolder& folder, const RecordFormat& format) {
  for (const std::string& file : folder.files()) {
    if (!file.starts_with("twin/records/")) continue;
    const std::string to =
        format.name + "/" + replaced_all(file.substr(5), ".csv", format.extension);
    format.write(record_columns_of(folder.read(file)), folder.work() / to);
  }
  folder.write(format.name + "/campaign.toml",
               replaced_all(folder.read("twin/campaign.toml"), ".csv", format.extension));
}

}  // namespace

TEST_CASE("fit: the same campaign in every format gives the same bits", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_two_chamber_twin(folder).exit_code == 0);
  REQUIRE(folder.run({"fit", "twin/campaign.toml", "--out", "csv", "--quiet"}).exit_code == 0);
  const json from_csv = found(folder, "csv");
  REQUIRE(from_csv.at("status") == "converged");
  REQUIRE(from_csv.at("parameters").size() > 10);
  for (const RecordFormat& format : record_formats()) {
    CAPTURE(format.name);
    write_as(folder, format);
    const std::string out = format.name + "-out";
    const Outcome fitted =
        folder.run({"fit", format.name + "/campaign.toml", "--out", out, "--quiet"});
    CHECK(fitted.err.empty());
    REQUIRE(fitted.exit_code == 0);
    CHECK(found(folder, out) == from_csv);
    CHECK(folder.read(out + "/residuals/square.csv") == folder.read("csv/residuals/square.csv"));
  }
}

TEST_CASE("check, average: the same campaign in every format gives the same bits", "[apps]") {
  const CommandFolder folder;
  REQUIRE(write_two_chamber_twin(folder).exit_code == 0);
  const auto checked = [&](const std::string& name) {
    const Outcome outcome = folder.run({"check", name + "/campaign.toml"});
    REQUIRE(outcome.exit_code == 0);
    return replaced_all(outcome.out, name + "/", "");
  };
  const auto averaged = [&](const std::string& name) {
    const std::string out = name + "-average";
    REQUIRE(folder.run({"average", name + "/campaign.toml", "--out", out}).exit_code == 0);
    return folder.read(out + "/averaged/square.csv");
  };
  const std::string check_of_csv = checked("twin");
  const std::string average_of_csv = averaged("twin");
  REQUIRE(average_of_csv.size() > 1000);
  for (const RecordFormat& format : record_formats()) {
    CAPTURE(format.name);
    write_as(folder, format);
    CHECK(checked(format.name) == check_of_csv);
    CHECK(averaged(format.name) == average_of_csv);
  }
}
