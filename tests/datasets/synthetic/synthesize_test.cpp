#include "datasets/synthetic/synthesize.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "common/error.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "tests/datasets/position_of.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::StartsWith;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::position_of;
using rigcal::test::TemporaryFolder;
using rigcal::test::text_of;
namespace fs = std::filesystem;

namespace {

/// The paper's rig at 10 Hz, so that a short record has several periods.
std::string campaign_text(const std::string& synthetic) {
  return R"(schema = "rigcal.campaign/1"
name = "twin"
[rig]
model = "load_pressure"
[rig.parameters]
mass = { start = "15 kg", lower = "1 kg", upper = "100 kg", fit = true }
damping = "1000 N s/m"
stiffness = "0 N/m"
piston_area = "633 mm^2"
total_volume = "468 cm^3"
supply_pressure = "6.2 MPa"
density = "850 kg/m^3"
bulk_modulus = "689 MPa"
discharge_coefficient = 0.6
area_gradient = "0.02 m^2/m"
valve_gain = "2e-5 m/V"
leakage_coefficient = { start = 0.3, lower = 0, upper = 5, fit = true, scope = "leak_level" }
leakage_area = "1 mm^2"
[rig.controller]
type = "pid"
kp = "1000 V/m"
[leak_level."33 %"]
[leak_level."66 %"]
[recording.channels]
time = { column = "t_ms", unit = "ms" }
reference = { column = "ref_mm", unit = "mm" }
position = { column = "x_mm", unit = "mm", gain = 2.0, offset = "3 mm" }
load_pressure = { column = "pl_bar", unit = "bar" }
[[condition]]
id = "square_33"
waveform = "square"
frequency = "10 Hz"
amplitude = "1 mm"
leak_level = "33 %"
repeats = ["nowhere/*.csv"]
[[condition]]
id = "sine_66"
waveform = "sine"
frequency = "10 Hz"
amplitude = "1 mm"
leak_level = "66 %"
repeats = ["nowhere/*.csv"]
[synthetic]
duration = "0.5 s"
sample_rate = "1 kHz"
)" + synthetic;
}

Campaign campaign_in(const TemporaryFolder& folder, const std::string& synthetic) {
  return load_campaign(folder.write("in.toml", campaign_text(synthetic)));
}

constexpr const char* kQuiet = "repeats = 1\n";

}  // namespace

TEST_CASE("synthesize: the same seed gives the same bytes for any number of threads",
          "[datasets]") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_in(folder, R"(repeats = 2
noise = { position = "0.01 mm" }
ar1_noise = { load_pressure = "0.1 bar" }
trigger_jitter = "1 ms"
supply_ripple = "0.1 MPa"
variation = { mass = 0.05 }
)");
  const auto one = synthesize(campaign, 7, folder.path() / "one", 1);
  synthesize(campaign, 7, folder.path() / "four", 4);
  synthesize(campaign, 8, folder.path() / "other", 2);
  CHECK(one.files == 4);
  CHECK(one.samples == 4 * 501);
  for (const char* name :
       {"campaign.toml", "truth.json", "records/square_33_r1.csv", "records/square_33_r2.csv",
        "records/sine_66_r1.csv", "records/sine_66_r2.csv"}) {
    CAPTURE(name);
    REQUIRE_FALSE(text_of(folder.path() / "one" / name).empty());
    CHECK(text_of(folder.path() / "one" / name) == text_of(folder.path() / "four" / name));
    CHECK(text_of(folder.path() / "one" / name) != text_of(folder.path() / "other" / name));
  }
  CHECK(text_of(folder.path() / "one/records/sine_66_r1.csv") !=
        text_of(folder.path() / "one/records/sine_66_r2.csv"));
}

TEST_CASE("synthesize: every file is labelled and the campaign loads", "[datasets]") {
  const TemporaryFolder folder;
  const auto report =
      synthesize(campaign_in(folder, "repeats = 3\n"), 42, folder.path() / "out", 1);
  CHECK_THAT(text_of(folder.path() / "out/records/sine_66_r3.csv"),
             StartsWith("# synthetic: made by rigcal synthesize, seed 42\n"
                        "t_ms,ref_mm,x_mm,pl_bar\n0,0,"));
  CHECK_THAT(text_of(report.campaign_file), StartsWith("# synthetic: made by rigcal synthesize"));
  const Campaign made = load_campaign(report.campaign_file);
  CHECK(made.synthetic);
  CHECK_FALSE(made.synthetic_settings.has_value());
  CHECK(made.name == "twin (synthetic)");
  for (const Condition& condition : made.conditions)
    CHECK(repeat_sources(made, condition).size() == 3);
}

TEST_CASE("synthesize: a record read back is the simulation in SI", "[datasets]") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_in(folder, kQuiet);
  const auto report = synthesize(campaign, 1, folder.path() / "out", 1);
  const Campaign made = load_campaign(report.campaign_file);
  for (const char* id : {"square_33", "sine_66"}) {
    CAPTURE(id);
    const Record record = load_record(made, *made.find(id));
    const Condition& condition = *campaign.find(id);
    const auto values = values_in(campaign, condition);
    rigcal::model::SimulationOptions options;
    options.tolerance = 1e-8;
    const auto run = rigcal::model::simulate(
        campaign.rig, values, {}, inputs_of(campaign, condition, values, nullptr), record.time_s,
        std::array{rigcal::model::Output::position, rigcal::model::Output::load_pressure}, options);
    REQUIRE(run.ok());
    REQUIRE(record.time_s.size() == 501);
    CHECK_THAT(record.time_s.back(), WithinAbs(0.5, 1e-12));
    // Numbers are written with ten digits. Positions are about 3 mm, pressures some bar.
    for (Eigen::Index i = 0; i < 501; ++i) {
      const auto at = static_cast<std::size_t>(i);
      CHECK_THAT(position_of(record).mean[at], WithinAbs(run.outputs(i, 0), 1e-11));
      CHECK_THAT(record.channels.at(Channel::load_pressure).mean[at],
                 WithinAbs(run.outputs(i, 1), 1e-2));
    }
    CHECK(run.outputs.col(0).cwiseAbs().maxCoeff() > 1e-4);  // the rig really moves
  }
  const Record square = load_record(made, *made.find("square_33"));
  CHECK(square.channels.at(Channel::reference).mean[0] == 1e-3);
  CHECK(square.channels.at(Channel::reference).mean[60] == -1e-3);
}

TEST_CASE("synthesize: noise has the standard deviation asked for", "[datasets]") {
  const TemporaryFolder folder;
  const auto report = synthesize(campaign_in(folder, R"(repeats = 8
noise = { position = "0.02 mm" }
ar1_noise = { load_pressure = "0.5 bar" }
ar1_coefficient = 0.5
)"),
                                 3, folder.path() / "out", 2);
  const Campaign made = load_campaign(report.campaign_file);
  const Record record = load_record(made, made.conditions[0]);
  // There are 3500 degrees of freedom, somewhat fewer for AR(1).
  CHECK_THAT(position_of(record).pooled_sd, WithinRel(0.02e-3, 0.05));
  CHECK_THAT(record.channels.at(Channel::load_pressure).pooled_sd, WithinRel(0.5e5, 0.07));
  CHECK(position_of(record).repeats == 8);
}

TEST_CASE("synthesize: channels and repeats have streams of their own", "[datasets]") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& settings, const std::string& out) {
    return load_campaign(
        synthesize(campaign_in(folder, settings), 3, folder.path() / out, 1).campaign_file);
  };
  const Campaign few = make("repeats = 1\nnoise = { position = \"1 mm\" }\n", "few");
  const Campaign more =
      make("repeats = 2\nnoise = { position = \"1 mm\", reference = \"1 mm\" }\n", "more");
  const auto repeat = [](const Campaign& campaign, std::size_t number) {
    return load_repeat(campaign, repeat_sources(campaign, campaign.conditions[0])[number]);
  };
  // A noisier reference and a second repeat leave the first position unchanged.
  CHECK(repeat(few, 0).values.at(Channel::position) ==
        repeat(more, 0).values.at(Channel::position));
  CHECK(repeat(more, 0).values.at(Channel::position) !=
        repeat(more, 1).values.at(Channel::position));
}

TEST_CASE("synthesize: quantised samples lie on the converter's steps", "[datasets]") {
  const TemporaryFolder folder;
  const auto report =
      synthesize(campaign_in(folder, "repeats = 1\nquantisation = { position = \"0.05 mm\" }\n"), 3,
                 folder.path() / "out", 1);
  const Campaign made = load_campaign(report.campaign_file);
  const Record record = load_record(made, made.conditions[0]);
  for (const double x : position_of(record).mean) {
    const double steps = x / 0.05e-3;
    CHECK_THAT(steps, WithinAbs(std::round(steps), 1e-6));
  }
}

TEST_CASE("synthesize: drift grows to its size at the end", "[datasets]") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& settings, const std::string& out) {
    const Campaign made = load_campaign(
        synthesize(campaign_in(folder, settings), 5, folder.path() / out, 1).campaign_file);
    return load_record(made, made.conditions[1]);
  };
  const Record plain = make(kQuiet, "plain");
  const Record drifting = make("repeats = 1\ndrift = { position = \"0.3 mm\" }\n", "drift");
  const auto difference = [&](std::size_t i) {
    return std::abs(position_of(drifting).mean[i] - position_of(plain).mean[i]);
  };
  CHECK_THAT(difference(0), WithinAbs(0.0, 1e-11));
  CHECK_THAT(difference(250), WithinAbs(0.15e-3, 1e-11));
  CHECK_THAT(difference(500), WithinAbs(0.3e-3, 1e-11));
}

TEST_CASE("synthesize: a late trigger is told by truth.json and found by the average",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto report = synthesize(
      campaign_in(folder,
                  "repeats = 5\ntrigger_jitter = \"3 ms\"\nnoise = { position = \"1 um\" }\n"),
      11, folder.path() / "out", 1);
  const Campaign made = load_campaign(report.campaign_file);
  const auto truth = nlohmann::json::parse(text_of(folder.path() / "out/truth.json"));
  for (std::size_t c = 0; c < 2; ++c) {
    const Record record = load_record(made, made.conditions[c]);
    const auto& repeats = truth["conditions"][c]["repeats"];
    REQUIRE(repeats.size() == 5);
    for (std::size_t r = 0; r < 5; ++r) {
      CAPTURE(c, r);
      CHECK(std::abs(repeats[r]["late_s"].get<double>()) > 0.0);
      // Compares two repeats, because the mean offset of the five is unknown. The tolerance is 0.1
      // samples, because the run does not start on the same samples in every repeat.
      CHECK_THAT(
          record.repeat_reports[r].offset_s - record.repeat_reports[0].offset_s,
          WithinAbs(repeats[r]["late_s"].get<double>() - repeats[0]["late_s"].get<double>(), 1e-4));
    }
  }
}

TEST_CASE("synthesize: supply ripple and variation make repeats differ", "[datasets]") {
  const TemporaryFolder folder;
  for (const char* settings : {"repeats = 2\nsupply_ripple = \"0.5 MPa\"\n",
                               "repeats = 2\nvariation = { valve_gain = 0.1 }\n"}) {
    CAPTURE(settings);
    const auto report = synthesize(campaign_in(folder, settings), 2, folder.path() / "out", 1);
    const Campaign made = load_campaign(report.campaign_file);
    const Record record = load_record(made, made.conditions[0]);
    CHECK(position_of(record).pooled_sd > 1e-7);
  }
  const auto truth = nlohmann::json::parse(text_of(folder.path() / "out/truth.json"));
  const auto& repeats = truth["conditions"][0]["repeats"];
  const double first = repeats[0]["varied"]["valve_gain_m_per_v"].get<double>();
  const double second = repeats[1]["varied"]["valve_gain_m_per_v"].get<double>();
  CHECK(first != second);
  CHECK_THAT(first, WithinRel(2e-5, 0.5));  // five standard deviations
}

TEST_CASE("synthesize: truth.json holds the true values by scope", "[datasets]") {
  const TemporaryFolder folder;
  const Campaign campaign = campaign_in(folder, R"(repeats = 1
parameters = { mass = "20 kg" }
[synthetic.leak_level."33 %"]
parameters = { leakage_coefficient = 0.4 }
[synthetic.leak_level."66 %"]
parameters = { leakage_coefficient = 0.9 }
)");
  synthesize(campaign, 18446744073709551615U, folder.path() / "out", 1);
  const auto truth = nlohmann::json::parse(text_of(folder.path() / "out/truth.json"));
  CHECK(truth["schema"] == "rigcal.truth/1");
  CHECK(truth["synthetic"] == true);
  CHECK(truth["seed"].get<std::uint64_t>() == 18446744073709551615U);
  double leak_33 = 0.0;
  double leak_66 = 0.0;
  int masses = 0;
  for (const auto& each : truth["parameters"]) {
    if (each["name"] == "mass_kg") {
      ++masses;
      CHECK(each["value"] == 20.0);
      CHECK(each["scope"] == "rig");
      CHECK(each["level"].is_null());
      CHECK(each["given"] == true);
    }
    if (each["name"] == "leakage_coefficient" && each["level"] == "33 %") leak_33 = each["value"];
    if (each["name"] == "leakage_coefficient" && each["level"] == "66 %") leak_66 = each["value"];
  }
  CHECK(masses == 1);
  CHECK(leak_33 == 0.4);
  CHECK(leak_66 == 0.9);
}

TEST_CASE("synthesize: true values move the rig, the campaign keeps its starts", "[datasets]") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& settings, const std::string& out) {
    return load_campaign(
        synthesize(campaign_in(folder, settings), 5, folder.path() / out, 1).campaign_file);
  };
  const Campaign starts = make(kQuiet, "starts");
  const Campaign truth = make("repeats = 1\nparameters = { mass = \"60 kg\" }\n", "truth");
  const int mass = rigcal::model::parameter_index(truth.rig.plant, "mass");
  CHECK(truth.setting(mass)->value == 15.0);
  CHECK(position_of(load_record(starts, starts.conditions[0])).mean !=
        position_of(load_record(truth, truth.conditions[0])).mean);
}

TEST_CASE("synthesize: what is missing is named", "[datasets]") {
  const TemporaryFolder folder;
  Campaign campaign = campaign_in(folder, kQuiet);
  campaign.conditions[0].duration_s = 0.5;
  campaign.synthetic_settings->duration_s = 0.0;
  CHECK_THROWS_WITH(synthesize(campaign, 1, folder.path() / "out", 2),
                    Contains("sine_66") && Contains("duration"));
  CHECK_FALSE(fs::exists(folder.path() / "out/campaign.toml"));
  campaign.synthetic_settings.reset();
  CHECK_THROWS_WITH(synthesize(campaign, 1, folder.path() / "out", 1), Contains("[synthetic]"));

  Campaign recorded = campaign_in(folder, kQuiet);
  recorded.conditions[0].waveform = Waveform::recorded;
  recorded.conditions[0].repeats.clear();
  CHECK_THROWS_WITH(synthesize(recorded, 1, folder.path() / "out", 1),
                    Contains("square_33") && Contains("recorded waveform"));
}

TEST_CASE("synthesize: a rig that cannot be simulated is no record", "[datasets]") {
  const TemporaryFolder folder;
  Campaign campaign = campaign_in(folder, kQuiet);
  campaign.simulation.max_seconds = 1e-9;
  CHECK_THROWS_AS(synthesize(campaign, 1, folder.path() / "out", 1), rigcal::NoResultError);
  CHECK_FALSE(fs::exists(folder.path() / "out/campaign.toml"));
}

TEST_CASE("synthesize: a recorded drive is driven again", "[datasets]") {
  const TemporaryFolder folder;
  const auto first = synthesize(campaign_in(folder, kQuiet), 1, folder.path() / "first", 1);
  Campaign again = load_campaign(first.campaign_file);
  again.synthetic_settings = SyntheticSettings{};
  again.synthetic_settings->repeats = 1;
  for (Condition& condition : again.conditions) condition.waveform = Waveform::recorded;
  const auto second = synthesize(again, 1, folder.path() / "second", 1);
  const Campaign made = load_campaign(second.campaign_file);
  const auto original = load_record(again, again.conditions[0]);
  const auto repeated = load_record(made, made.conditions[0]);
  // A stepped square reference is the square itself. Edges are on samples, up to rounding.
  for (std::size_t i = 0; i < original.time_s.size(); ++i)
    CHECK_THAT(position_of(repeated).mean[i], WithinAbs(position_of(original).mean[i], 1e-8));
}
