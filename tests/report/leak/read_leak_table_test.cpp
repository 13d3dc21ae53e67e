#include "report/leak/read_leak_table.hpp"

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "report/json/described.hpp"
#include "report/store/stored/stored_leak_table.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;

namespace {

diagnosis::LeakEntry entry(datasets::Waveform waveform, double frequency_hz, double target_percent,
                           std::vector<double> coefficients,
                           std::vector<std::optional<Range>> ci95) {
  diagnosis::LeakEntry entry;
  entry.drive = diagnosis::LeakDrive{waveform, frequency_hz, 0.05, {}};
  entry.target_percent = target_percent;
  entry.coefficients = std::move(coefficients);
  entry.coefficients_ci95 = std::move(ci95);
  return entry;
}

const std::string kTable = [] {
  using datasets::Waveform;
  StoredLeakTable table;
  table.assumptions = {{"mass_kg", "mass", 85.0, "kg", "fit"},
                       {"residual_scale_per_m", "residual_scale", 55.0, "1/m", "a guess"}};
  table.entries = {entry(Waveform::sine, 0.1, 20.0, {0.35}, {Range{0.34, 0.36}}),
                   entry(Waveform::sine, 0.1, 10.0, {0.1, 0.2}, {std::nullopt, Range{0.19, 0.21}}),
                   entry(Waveform::square, 1.0, 20.0, {}, {})};
  return json_of(table).dump();
}();

EarlierLeakTable read_table_text(const std::string& text) {
  const test::TemporaryFolder folder;
  return read_leak_table(folder.write("leak_table.json", text), model::PlantKind::load_pressure);
}

/// Returns the error message for the table with `from` replaced.
std::string table_complaint(const std::string& from, const std::string& to) {
  try {
    read_table_text(test::replaced(kTable, from, to));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("read_leak_table: rows, coefficients and the rig", "[report]") {
  const EarlierLeakTable table = read_table_text(kTable);
  CHECK(table.targets_percent == std::vector{10.0, 20.0});
  REQUIRE(table.rig.size() == 1);
  CHECK(table.rig[0].first == model::parameter_index(model::PlantKind::load_pressure, "mass"));
  CHECK(table.rig[0].second == 85.0);
  REQUIRE(table.limits.size() == 3);
  CHECK(table.limits[1].coefficients == std::vector{0.1, 0.2});
  CHECK_FALSE(table.limits[1].coefficients_ci95[0].has_value());
  CHECK(table.limits[1].coefficients_ci95[1] == rigcal::Range{0.19, 0.21});
  CHECK(table.limits[2].drive.waveform == datasets::Waveform::square);
  CHECK(table.limits[2].coefficients.empty());
}

TEST_CASE("read_leak_table: what is wrong is named", "[report]") {
  CHECK_THAT(table_complaint("leak_table/1", "fit/1"),
             Contains("expected \"rigcal.leak_table/1\""));
  CHECK_THAT(table_complaint("\"assumptions\"", "\"assumed\""),
             Contains("'assumptions' is missing; is this a leak_table.json?"));
  CHECK_THAT(table_complaint("mass_kg", "mass_g"), Contains("such as mass_kg"));
  CHECK_THAT(table_complaint("\"square\"", "\"saw\""), Contains("entries[2].waveform"));
  CHECK_THAT(table_complaint("[[0.34,0.36]]", "[]"),
             Contains("entries[0].coefficients_ci95") && Contains("per coefficient"));
}

TEST_CASE("rig_differences: names what flows depend on, with both values", "[report]") {
  datasets::Campaign campaign = datasets::load_campaign(
      std::string(RIGCAL_SOURCE_DIR) + "/datasets/rigs/uis_shake_table/campaign.toml");
  const auto index = [&](const char* key) {
    return model::parameter_index(campaign.rig.plant, key);
  };
  EarlierLeakTable table;
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    if (setting.index != index("leakage_coefficient"))
      table.rig.emplace_back(setting.index, setting.value);
  }
  CHECK(rig_differences(table, campaign, {}).empty());
  const std::vector<datasets::FittedValue> fitted{
      {index("mass"), datasets::Scope::rig, "", 85.0},
      {index("leakage_coefficient"), datasets::Scope::leak_level, "0 %", 0.1}};
  const auto differences = rig_differences(table, campaign, fitted);
  REQUIRE(differences.size() == 1);
  CHECK(differences[0] == "mass is 60 kg in the table, 85 kg in the diagnosis");
  // A term that only the table's rig has.
  table.rig.emplace_back(index("coulomb_friction"), 50.0);
  CHECK_THAT(rig_differences(table, campaign, {}).at(0), Contains("coulomb_friction is 50 N"));
}
