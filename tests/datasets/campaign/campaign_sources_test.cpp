#include <catch2/catch.hpp>
#include <cmath>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::kExample;
using rigcal::test::load_text;
using rigcal::test::replaced;
using rigcal::test::TemporaryFolder;

namespace {

std::vector<std::string> labels(const std::vector<RepeatSource>& sources) {
  std::vector<std::string> result;
  for (const RepeatSource& source : sources) result.push_back(source.label);
  return result;
}

Record ramp_record(Channel channel) {
  Record record;
  record.condition = "steps";
  record.time_s = {0.0, 1.0, 2.0};
  record.channels[channel].mean = {0.0, 10.0, 20.0};
  return record;
}

}  // namespace

TEST_CASE("repeat_sources: patterns are expanded and sorted", "[datasets]") {
  const TemporaryFolder folder;
  for (const char* name : {"records/sine_0.1Hz_33_2.csv", "records/sine_0.1Hz_33_1.csv",
                           "records/sine_0.1Hz_50_1.csv", "records/.sine_0.1Hz_33_3.csv"}) {
    folder.write(name, "t\n");
  }
  const Campaign campaign = load_campaign(folder.write("campaign.toml", kExample));
  const auto sources = repeat_sources(campaign, campaign.conditions[0]);
  CHECK(labels(sources) ==
        std::vector<std::string>{"records/sine_0.1Hz_33_1.csv", "records/sine_0.1Hz_33_2.csv"});
  CHECK(sources[0].columns == std::map<Channel, std::string>{{Channel::reference, "ref_mm"},
                                                             {Channel::position, "x_mm"}});
}

TEST_CASE("repeat_sources: question marks and patterns for folders", "[datasets]") {
  const TemporaryFolder folder;
  for (const char* name : {"day1/a1.csv", "day2/a2.csv", "day2/a10.csv", "other/a1.csv"}) {
    folder.write(name, "t\n");
  }
  const auto campaign = load_campaign(folder.write(
      "campaign.toml", replaced(kExample, "records/sine_0.1Hz_33_*.csv", "day?/a?.csv")));
  CHECK(labels(repeat_sources(campaign, campaign.conditions[0])) ==
        std::vector<std::string>{"day1/a1.csv", "day2/a2.csv"});
}

TEST_CASE("repeat_sources: columns of one file", "[datasets]") {
  const TemporaryFolder folder;
  folder.write("data/steps_1V.csv", "t\n");
  const auto file = folder.write("campaign.toml", kExample);
  const Campaign campaign = load_campaign(file, folder.path() / "data");
  const auto sources = repeat_sources(campaign, campaign.conditions[1]);
  REQUIRE(sources.size() == 20);
  CHECK(sources[0].label == "steps_1V.csv 01");
  CHECK(sources[9].columns.at(Channel::position) == "x_mm_A10");
  CHECK_FALSE(sources[9].columns.contains(Channel::pressure_b));
  CHECK(sources[10].columns.at(Channel::pressure_b) == "pB_bar_01");
  CHECK(sources[10].columns.at(Channel::reference) == "ref_mm");
}

TEST_CASE("repeat_sources: says where it searched in vain", "[datasets]") {
  const Campaign campaign = load_text(kExample);
  CHECK_THROWS_WITH(repeat_sources(campaign, campaign.conditions[0]),
                    Catch::Contains("sine_0.1Hz_33_*.csv") &&
                        Catch::Contains((campaign.data_dir / "records").string()));
  CHECK_THROWS_AS(repeat_sources(campaign, campaign.conditions[1]), InputError);
}

TEST_CASE("repeat_sources: no file counts twice", "[datasets]") {
  const TemporaryFolder folder;
  folder.write("a1.csv", "t\n");
  const Campaign campaign = load_campaign(folder.write(
      "campaign.toml",
      replaced(kExample, "\"records/sine_0.1Hz_33_*.csv\"", "\"a*.csv\", \"./a1.csv\"")));
  CHECK_THROWS_WITH(repeat_sources(campaign, campaign.conditions[0]),
                    Catch::Contains("matched twice"));
}

TEST_CASE("inputs_of: generated waveforms", "[datasets]") {
  const Campaign campaign = load_text(kExample);
  const Condition& sine = campaign.conditions[0];
  const auto inputs = inputs_of(campaign, sine, values_in(campaign, sine), nullptr);
  // 2.5 s is a quarter of the period at 0.1 Hz.
  CHECK_THAT(inputs.drive.value(2.5), WithinRel(0.0508, 1e-12));
  CHECK_FALSE(inputs.external_load.has_value());
  CHECK_FALSE(inputs.supply_pressure_pa.has_value());

  Condition square = sine;
  square.waveform = Waveform::square;
  const auto edges = inputs_of(campaign, square, values_in(campaign, square), nullptr);
  CHECK(edges.drive.value(1.0) == sine.amplitude.value());
  CHECK(edges.drive.value(6.0) == -sine.amplitude.value());

  Condition chirp = sine;
  chirp.waveform = Waveform::chirp;
  chirp.end_frequency_hz = 1.0;
  CHECK_THROWS_AS(inputs_of(campaign, chirp, values_in(campaign, chirp), nullptr), InputError);
  chirp.sweep_s = 10.0;
  const auto sweep = inputs_of(campaign, chirp, values_in(campaign, chirp), nullptr);
  // The phase of a linear chirp is 2 pi (f0 t + (f1 - f0) t^2 / (2 T)).
  CHECK_THAT(sweep.drive.value(2.0),
             WithinAbs(0.0508 * std::sin(2.0 * std::acos(-1.0) * (0.2 + 0.9 * 4.0 / 20.0)), 1e-9));
}

TEST_CASE("inputs_of: recorded channels are held or joined", "[datasets]") {
  Campaign campaign = load_text(kExample);
  const Condition& steps = campaign.conditions[1];
  const auto values = values_in(campaign, steps);
  const Record record = ramp_record(Channel::reference);
  CHECK(inputs_of(campaign, steps, values, &record).drive.value(1.5) == 10.0);
  campaign.channels[Channel::reference].interpolation = Interpolation::linear;
  CHECK(inputs_of(campaign, steps, values, &record).drive.value(1.5) == 15.0);
  CHECK_THROWS_AS(inputs_of(campaign, steps, values, nullptr), std::invalid_argument);
  const Record other = ramp_record(Channel::position);
  CHECK_THROWS_WITH(inputs_of(campaign, steps, values, &other), Catch::Contains("reference"));
}

TEST_CASE("inputs_of: measured force and supply act on the rig", "[datasets]") {
  const Campaign campaign =
      load_text(replaced(kExample, "[averaging]",
                         "force = { column = \"f\", unit = \"N\", role = \"input\" }\n"
                         "supply_pressure = { column = \"p\", unit = \"Pa\" }\n[averaging]"));
  Record record = ramp_record(Channel::force);
  record.channels[Channel::supply_pressure].mean = {1.0, 2.0, 3.0};
  const Condition& sine = campaign.conditions[0];
  const auto inputs = inputs_of(campaign, sine, values_in(campaign, sine), &record);
  REQUIRE(inputs.external_load.has_value());
  REQUIRE(inputs.supply_pressure_pa.has_value());
  CHECK(inputs.external_load->value(1.5) == 10.0);
  CHECK(inputs.supply_pressure_pa->value(2.5) == 3.0);
}

TEST_CASE("inputs_of: a measured acceleration of the base acts on the rig", "[datasets]") {
  const auto with_base = [](const std::string& more) {
    return replaced(
        kExample, "[averaging]",
        "base_acceleration = { column = \"a\", unit = \"gravity\"" + more + " }\n[averaging]");
  };
  const Campaign campaign = load_text(with_base(""));
  CHECK(campaign.channels.at(Channel::base_acceleration).to_si.scale == 9.80665);
  const Record record = ramp_record(Channel::base_acceleration);
  const Condition& sine = campaign.conditions[0];
  const auto inputs_from = [&](const Campaign& from) {
    return inputs_of(from, sine, values_in(from, sine), &record).base_acceleration_m_per_s2;
  };
  REQUIRE(inputs_from(campaign).has_value());
  CHECK(inputs_from(campaign)->value(1.5) == 10.0);
  CHECK_FALSE(inputs_from(load_text(with_base(", role = \"ignore\""))).has_value());
  CHECK_THROWS_WITH(load_text(with_base(", role = \"output\"")),
                    Catch::Contains("the model does not compute base_acceleration"));
}

TEST_CASE("inputs_of: the oil follows a recorded temperature where its properties have a reference",
          "[datasets]") {
  const auto with_channel = [](const std::string& text, const std::string& role) {
    return replaced(text, "[averaging]",
                    "temperature = { column = \"T_C\", unit = \"degC\"" + role + " }\n[averaging]");
  };
  const std::string input = ", role = \"input\"";
  const std::string parameters = "[rig.parameters]\n";
  const std::string oil =
      parameters + "reference_temperature = \"40 degC\"\nviscosity_decay = \"0.03 1/K\"\n";
  const Campaign campaign = load_text(with_channel(replaced(kExample, parameters, oil), input));
  const Record record = ramp_record(Channel::temperature);
  const Condition& condition = campaign.conditions[0];
  const auto values = values_in(campaign, condition);
  CHECK(values["reference_temperature"] == Approx(313.15));
  const auto inputs = inputs_of(campaign, condition, values, &record);
  REQUIRE(inputs.oil_temperature_k.has_value());
  CHECK(inputs.oil_temperature_k->value(1.5) == 10.0);
  CHECK_THROWS_WITH(load_text(with_channel(kExample, input)),
                    Catch::Contains("no property of the oil depends on it: expected "
                                    "reference_temperature"));
  CHECK_THROWS_WITH(
      load_text(replaced(kExample, parameters, parameters + "viscosity_decay = \"0.03 1/K\"\n")),
      Catch::Contains("viscosity_decay without reference_temperature"));
  // Without a recorded temperature it is that of the condition, or the parameter.
  const std::string without = with_channel(replaced(kExample, parameters, oil), "");
  CHECK_THROWS_WITH(load_text(without), Catch::Contains("but no temperature of the oil"));
  const Campaign given =
      load_text(replaced(without, parameters, parameters + "oil_temperature = \"50 degC\"\n"));
  CHECK(values_in(given, given.conditions[0])["oil_temperature"] == Approx(323.15));
  CHECK_FALSE(inputs_of(given, given.conditions[0], values_in(given, given.conditions[0]), &record)
                  .oil_temperature_k.has_value());
}

TEST_CASE("sample_times: of the record, or of duration and rate", "[datasets]") {
  Condition condition;
  CHECK_THROWS_AS(sample_times(condition, nullptr), InputError);
  condition.duration_s = 0.3;
  condition.sample_rate_hz = 10.0;
  // 0.3 * 10 may be slightly less than 3, but the last sample must not be lost.
  CHECK(sample_times(condition, nullptr).size() == 4);
  CHECK(sample_times(condition, nullptr).back() == 0.3);
  const Record record = ramp_record(Channel::position);
  CHECK(sample_times(condition, &record) == record.time_s);
}
