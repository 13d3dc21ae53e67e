// Records of a known rig, corrupted by errors in a sensor or a data sheet, or by an assistant's
// mistake. In closed loop, the model follows the position almost regardless of the error, so the
// scores reveal little. The other checks must notice it.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/apps/cli_fixture.hpp"

using Catch::Contains;
using nlohmann::json;
using rigcal::test::CommandFolder;
using rigcal::test::Outcome;

namespace {

constexpr std::size_t kPosition = 2;
constexpr std::size_t kLoadPressure = 3;
using Cells = std::vector<double>;

const rigcal::test::Edits kStrictLimits{
    {"rho2 = 0.9\n", "rho2 = 0.99\nwarn_rho2 = 0.995\nccc = 0.99\nabsolute_error_percent = 1.0\n"}};

/// Changes the cells (time, reference, position, load pressure) in every record of the twin.
void change_records(const CommandFolder& folder, const std::function<void(Cells&)>& change) {
  for (const char* name : {"sine", "square"}) {
    for (int repeat = 1; repeat <= 3; ++repeat) {
      const std::string file = fmt::format("twin/records/{}_r{}.csv", name, repeat);
      std::istringstream csv(folder.read(file));
      std::string changed;
      for (std::string line; std::getline(csv, line);) {
        if (line.find_first_of("0123456789-") != 0) {
          changed += line + "\n";
          continue;
        }
        Cells cells;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
          cells.push_back(std::stod(field));
        REQUIRE(cells.size() == 4);
        change(cells);
        changed += fmt::format("{}\n", fmt::join(cells, ","));
      }
      folder.write(file, changed);
    }
  }
}

void change_campaign(const CommandFolder& folder, const rigcal::test::Edits& edits) {
  folder.write("twin/campaign.toml",
               rigcal::test::edited(folder.read("twin/campaign.toml"), edits));
}

struct Judged {
  Outcome run;
  json fit;
  std::string verdict() const { return fit["verdict"]; }
  std::string state(const char* aspect) const { return fit["assessment"][aspect]["state"]; }
  bool names(const char* aspect, const std::string& code) const {
    for (const json& reason : fit["assessment"][aspect]["reasons"]) {
      if (reason["code"] == code) return true;
    }
    return false;
  }
};

Judged judged(const CommandFolder& folder) {
  Judged result{folder.run({"fit", "twin/campaign.toml", "--out", "out", "--threads", "1"}), {}};
  CAPTURE(result.run.err);
  REQUIRE(folder.has("out/fit.json"));
  result.fit = json::parse(folder.read("out/fit.json"));
  return result;
}

}  // namespace

TEST_CASE("wrong sensor: records of the model itself pass", "[apps]") {
  const CommandFolder folder;
  REQUIRE(rigcal::test::write_twin(folder, kStrictLimits).exit_code == 0);
  const Judged result = judged(folder);
  CHECK(result.run.exit_code == 0);
  CHECK(result.verdict() == "PASS");
}

TEST_CASE("wrong sensor: what keeps every limit of the position is a lack of fit", "[apps]") {
  struct Row {
    const char* name;
    std::function<void(const CommandFolder&)> spoil;
  };
  const auto pressure = [](double factor) {
    return [factor](const CommandFolder& folder) {
      change_records(folder, [factor](Cells& cells) { cells[kLoadPressure] *= factor; });
    };
  };
  const Row row = GENERATE_COPY(values<Row>({
      {"sign of the pressure", pressure(-1.0)},
      {"pressure 20 % too large", pressure(1.2)},
      {"position 2 % too large",
       [](const CommandFolder& folder) {
         change_records(folder, [](Cells& cells) { cells[kPosition] *= 1.02; });
       }},
      {"piston area 20 % too large",
       [](const CommandFolder& folder) {
         change_campaign(folder, {{"piston_area = \"633 mm2\"", "piston_area = \"760 mm2\""}});
       }},
      {"supply pressure 20 % too large",
       [](const CommandFolder& folder) {
         change_campaign(folder,
                         {{"supply_pressure = \"6.2 MPa\"", "supply_pressure = \"7.44 MPa\""}});
       }},
  }));
  CAPTURE(row.name);
  const CommandFolder folder;
  REQUIRE(rigcal::test::write_twin(folder, kStrictLimits).exit_code == 0);
  row.spoil(folder);
  const Judged result = judged(folder);
  CHECK(result.run.exit_code == 0);
  CHECK(result.verdict() == "WARN");
  CHECK(result.state("agreement") == "pass");
  CHECK(result.state("adequacy") == "reservation");
  CHECK(result.names("adequacy", "lack_of_fit"));
  CHECK_THAT(result.run.out, Contains("Passed with reservations") && Contains("lack of fit in "));
  CHECK_THAT(folder.read("out/report.html"), Contains("<title>WARN"));
  CHECK(folder.run({"fit", "twin/campaign.toml", "--out", "strict", "--strict"}).exit_code == 1);
}

TEST_CASE("wrong sensor: what breaks a limit fails", "[apps]") {
  struct Row {
    const char* name;
    std::function<void(Cells&)> change;
  };
  const Row row = GENERATE(values<Row>({
      {"psi taken for bar", [](Cells& cells) { cells[kLoadPressure] *= 14.5038; }},
      {"offset of 1 mm", [](Cells& cells) { cells[kPosition] += 1.0; }},
  }));
  CAPTURE(row.name);
  const CommandFolder folder;
  REQUIRE(rigcal::test::write_twin(folder, kStrictLimits).exit_code == 0);
  change_records(folder, row.change);
  const Judged result = judged(folder);
  CHECK(result.run.exit_code == 1);
  CHECK(result.verdict() == "FAIL");
  CHECK(result.state("agreement") == "fail");
}

TEST_CASE("wrong sensor: a clipped one is named, even under limits that it keeps", "[apps]") {
  const CommandFolder folder;
  REQUIRE(rigcal::test::write_twin(folder).exit_code == 0);
  change_records(folder,
                 [](Cells& cells) { cells[kPosition] = std::clamp(cells[kPosition], -4.0, 4.0); });
  const Judged result = judged(folder);
  CHECK(result.run.exit_code == 0);
  CHECK(result.verdict() == "WARN");
  CHECK(result.names("agreement", "recording_doubtful"));
  CHECK(result.names("adequacy", "lack_of_fit"));
  CHECK_THAT(
      result.run.out,
      Contains("stays at exactly its highest value, as if the sensor or amplifier were saturated"));
}

TEST_CASE("wrong sensor: a limit that cannot be evaluated fails", "[apps]") {
  const CommandFolder folder;
  REQUIRE(rigcal::test::write_twin(folder, kStrictLimits).exit_code == 0);
  change_campaign(folder, {{"kp = \"1000 V/m\"", "kp = \"0 V/m\""}});
  const Judged result = judged(folder);
  CHECK(result.run.exit_code == 1);
  CHECK(result.verdict() == "FAIL");
  CHECK(result.names("agreement", "limit_not_evaluable"));
  CHECK(result.state("parameters") == "reservation");
}
