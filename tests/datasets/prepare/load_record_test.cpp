#include "datasets/prepare/load_record.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "common/error.hpp"
#include "datasets/prepare/decimate.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// A campaign like one from the loader: position in mm, pressure in bar, time in ms.
Campaign campaign_in(const TemporaryFolder& files) {
  Campaign campaign;
  campaign.file = files.path() / "campaign.toml";
  campaign.data_dir = files.path();
  campaign.time_column = "t";
  campaign.time_to_s = {1e-3, 0.0};
  campaign.alignment = Alignment::none;
  ChannelSetting position;
  position.channel = Channel::position;
  position.column = "x";
  position.to_si = {1e-3, 0.5};
  campaign.channels[Channel::position] = position;
  ChannelSetting pressure;
  pressure.channel = Channel::pressure_a;
  pressure.to_si = {1e5, 0.0};
  campaign.channels[Channel::pressure_a] = pressure;
  return campaign;
}

Condition condition_of(const std::string& id, const std::string& pattern) {
  Condition condition;
  condition.id = id;
  condition.repeats.push_back({pattern, {}, {}});
  condition.where = {"campaign.toml", 12, 1};
  return condition;
}

}  // namespace

TEST_CASE("load_record: a second column is taken off the first before units", "[datasets]") {
  const TemporaryFolder files;
  files.write("a.csv", "t,x,a,b,c\n0,1,5,2,9\n10,2,6,2.5,8\n20,4,7,1,7\n");
  Campaign campaign = campaign_in(files);
  ChannelSetting load;
  load.channel = Channel::load_pressure;
  load.column = "a";
  load.minus = "b";
  load.to_si = {1e5, 10.0};
  campaign.channels[Channel::load_pressure] = load;
  Condition condition = condition_of("a", "a.csv");
  const auto load_at = [&](std::size_t i) {
    return load_record(campaign, condition).channels.at(Channel::load_pressure).mean[i];
  };
  CHECK_THAT(load_at(0), WithinRel(3e5 + 10.0, 1e-12));
  CHECK_THAT(load_at(2), WithinRel(6e5 + 10.0, 1e-12));
  // A column that the repeat itself names has no `minus`.
  condition.repeats[0].columns[Channel::load_pressure] = "c";
  CHECK_THAT(load_at(0), WithinRel(9e5 + 10.0, 1e-12));
  // Both columns must be in the unit of the campaign.
  files.write("units.csv", "t,x,a [bar],b [psi]\n0,1,5,2\n10,2,6,2.5\n20,4,7,1\n");
  campaign.channels[Channel::load_pressure].stated.unit = "bar";
  CHECK_THROWS_WITH(load_record(campaign, condition_of("units", "units.csv")),
                    Contains("column 'b [psi]' is in psi"));
}

TEST_CASE("load_record: a number that nothing can measure is refused", "[datasets]") {
  const TemporaryFolder files;
  files.write("a.csv", "t,x\n0,1\n10,-1e300\n20,4\n");
  CHECK_THROWS_WITH(load_record(campaign_in(files), condition_of("a", "a.csv")),
                    Contains("a.csv: number 2 of 'x' is -1e+297 in SI units") &&
                        Contains("expected at most 1e+100"));
  files.write("b.csv", "t,x\n0,1\n10,2\n1e300,4\n");
  CHECK_THROWS_WITH(load_record(campaign_in(files), condition_of("b", "b.csv")),
                    Contains("b.csv: number 3 of 't'"));
}

TEST_CASE("load_record: columns become SI channels, repeats a mean", "[datasets]") {
  const TemporaryFolder files;
  files.write("a_1.csv", "t,x,other\n0,1,a\n10,2,b\n20,4,c\n");
  files.write("a_2.csv", "t,x,other\n0,3,a\n10,2,b\n20,8,c\n");
  const Record record = load_record(campaign_in(files), condition_of("a", "a_*.csv"));
  CHECK(record.condition == "a");
  CHECK(record.repeats == 2);
  REQUIRE(record.time_s.size() == 3);
  CHECK_THAT(record.time_s[2], WithinAbs(0.02, 1e-15));
  const Series& position = record.channels.at(Channel::position);
  CHECK_THAT(position.mean[0], WithinAbs(0.502, 1e-15));
  CHECK_THAT(position.mean[2], WithinAbs(0.506, 1e-15));
  CHECK_THAT(position.sd[2], WithinRel(std::sqrt(8.0) * 1e-3, 1e-9));
  std::vector<std::string> names;
  for (const rigcal::FileState& file : record.files) names.push_back(file.path);
  CHECK(names == std::vector<std::string>{(files.path() / "a_1.csv").string(),
                                          (files.path() / "a_2.csv").string()});
  REQUIRE(record.repeat_reports.size() == 2);
  CHECK(record.repeat_reports[1].source == "a_2.csv");
  CHECK(record.channels.count(Channel::pressure_a) == 0);  // no repeat has this channel
}

TEST_CASE("load_record: columns of one file as repeats with different channels", "[datasets]") {
  const TemporaryFolder files;
  files.write("all.csv", "t,x1,x2,p1\n0,1,3,5\n10,2,2,6\n20,4,8,7\n");
  Condition condition;
  condition.id = "steps";
  condition.repeats.push_back(
      {"all.csv", {"1"}, {{Channel::position, "x{n}"}, {Channel::pressure_a, "p{n}"}}});
  condition.repeats.push_back({"all.csv", {"2"}, {{Channel::position, "x{n}"}}});
  const Record record = load_record(campaign_in(files), condition);
  CHECK(record.channels.at(Channel::position).repeats == 2);
  CHECK(record.channels.at(Channel::pressure_a).repeats == 1);
  CHECK_THAT(record.channels.at(Channel::pressure_a).mean[2], WithinAbs(7e5, 1e-6));
  CHECK(record.files.size() == 1);
}

TEST_CASE("load_record: an averaged file keeps the sd of its samples", "[datasets]") {
  const TemporaryFolder files;
  files.write("mean.csv", "t,x\n0,1\n10,2\n");
  Campaign campaign = campaign_in(files);
  campaign.channels[Channel::position].sd = 2e-5;
  Condition condition;
  condition.id = "a";
  condition.averaged = "mean.csv";
  condition.repeats_averaged = 5;
  const Record record = load_record(campaign, condition);
  CHECK(record.repeats == 5);
  CHECK(record.channels.at(Channel::position).sd_of_mean == 2e-5);
  CHECK(record.channels.at(Channel::position).repeats == 5);
}

TEST_CASE("load_record: repeats that do not belong together name their condition", "[datasets]") {
  const TemporaryFolder files;
  files.write("a_1.csv", "t,x\n0,1\n10,2\n20,4\n");
  files.write("a_2.csv", "t,x\n0,1\n25,2\n50,4\n");
  try {
    load_record(campaign_in(files), condition_of("a", "a_*.csv"));
    FAIL("no error");
  } catch (const rigcal::InputError& error) {
    CHECK_THAT(error.what(), Contains("campaign.toml:12:1") && Contains("\"a\"") &&
                                 Contains("a_1.csv") && Contains("a_2.csv"));
  }
  Condition none;
  none.id = "none";
  CHECK_THROWS_AS(load_record(campaign_in(files), none), rigcal::InputError);
  files.write("b.csv", "t,y\n0,1\n");
  CHECK_THROWS_WITH(load_record(campaign_in(files), condition_of("b", "b.csv")),
                    Contains("b.csv") && Contains("x"));
  Campaign timeless = campaign_in(files);
  timeless.time_column.clear();
  CHECK_THROWS_WITH(load_record(timeless, condition_of("a", "a_1.csv")), Contains("time"));
}

TEST_CASE("load_records: the campaign's order, the uses asked for, any threads", "[datasets]") {
  const TemporaryFolder files;
  Campaign campaign = campaign_in(files);
  for (const std::string id : {"d", "c", "b", "a"}) {
    files.write(id + ".csv", "t,x\n0,1\n10,2\n");
    campaign.conditions.push_back(condition_of(id, id + ".csv"));
  }
  campaign.conditions[1].use = Use::validate;
  campaign.conditions[2].use = Use::ignore;
  for (const int threads : {1, 3}) {
    const auto records = load_records(campaign, {Use::fit, Use::validate}, threads);
    REQUIRE(records.size() == 3);
    CHECK(records[0].condition == "d");
    CHECK(records[1].condition == "c");
    CHECK(records[2].condition == "a");
  }
  CHECK(load_records(campaign, {Use::diagnose}, 2).empty());
}

TEST_CASE("load_record: repeats that carry different channels, each with its own count",
          "[datasets]") {
  const TemporaryFolder files;
  files.write("a.csv", "t,x1,p1,x2,p2,x3\n0,1,10,3,20,5\n10,2,12,4,22,6\n20,3,14,5,24,7\n");
  Condition condition = condition_of("a", "a.csv");
  condition.repeats = {
      {"a.csv", {"1", "2"}, {{Channel::position, "x{n}"}, {Channel::pressure_a, "p{n}"}}},
      {"a.csv", {"3"}, {{Channel::position, "x{n}"}}}};
  const Record record = load_record(campaign_in(files), condition);
  CHECK(record.repeats == 3);
  const Series& position = record.channels.at(Channel::position);
  const Series& pressure = record.channels.at(Channel::pressure_a);
  CHECK(position.repeats == 3);
  CHECK(position.count == std::vector<int>{3, 3, 3});
  CHECK_THAT(position.mean[0], WithinAbs(0.503, 1e-15));
  CHECK(pressure.repeats == 2);
  CHECK(pressure.count == std::vector<int>{2, 2, 2});
  CHECK_THAT(pressure.mean[1], WithinAbs(17e5, 1e-6));
  CHECK_THAT(pressure.sd_of_mean, WithinRel(pressure.pooled_sd / std::sqrt(2.0), 1e-12));
  CHECK(record.files.size() == 1);
}

TEST_CASE("load_record: moving windows of a recorded command", "[datasets]") {
  const TemporaryFolder files;
  std::string text = "t,u,x,still\n";
  for (int i = 0; i < 2000; ++i) {  // steps at 100 ms and 1000 ms, 0.2 mm per ms
    const double x = i < 100    ? 0.0
                     : i < 1000 ? std::min(100.0, 0.2 * (i - 100))
                                : std::max(0.0, 100.0 - 0.2 * (i - 1000));
    text += std::to_string(i) +
            (i < 100    ? ",0,"
             : i < 1000 ? ",2,"
                        : ",-2,") +
            std::to_string(x) + ",7\n";
  }
  files.write("a.csv", text);
  Campaign campaign = campaign_in(files);
  ChannelSetting command;
  command.channel = Channel::command;
  command.column = "u";
  command.to_si = {1.0, 0.0};
  command.role = ChannelRole::input;
  campaign.channels[Channel::command] = command;
  campaign.rig.controller = rigcal::model::ControllerKind::none;
  Condition condition = condition_of("a", "a.csv");
  condition.moving_windows = true;
  const Record record = load_record(campaign, condition);
  REQUIRE(record.windows.size() == 2);
  CHECK_THAT(record.windows[0].start_s, WithinAbs(0.1, 1e-9));
  CHECK_THAT(record.windows[0].end_s, WithinAbs(0.595, 2e-3));
  CHECK_THAT(record.windows[1].start_s, WithinAbs(1.0, 1e-9));
  CHECK_THAT(record.windows[1].end_s, WithinAbs(1.495, 2e-3));
  REQUIRE(record.notes.size() == 2);
  CHECK_THAT(record.notes[0], Contains("moving window 1: 0.1 s to 0.59"));

  campaign.channels[Channel::position].column = "still";
  CHECK_THROWS_WITH(load_record(campaign, condition),
                    Contains("no step of the command moves the piston"));
  campaign.channels.erase(Channel::position);
  CHECK_THROWS_WITH(load_record(campaign, condition), Contains("are found from the position"));
}

TEST_CASE("load_record: the moving windows of a real step test", "[datasets]") {
  const fs::path folder = fs::path(RIGCAL_RECORDINGS_DIR) / "festo_tp511_servo_cylinder";
  if (!fs::exists(folder / "steps_4V_1kHz.csv")) {
    WARN("skipped: no recordings in " << folder.string());
    return;
  }
  Campaign campaign = campaign_in(TemporaryFolder());
  campaign.data_dir = folder;
  campaign.time_column = "t_s";
  campaign.time_to_s = {1.0, 0.0};
  campaign.channels[Channel::position].column = "";
  campaign.channels[Channel::position].to_si = {1e-3, 0.0};
  ChannelSetting command;
  command.channel = Channel::command;
  command.column = "u_V";
  command.role = ChannelRole::input;
  campaign.channels[Channel::command] = command;
  campaign.rig.controller = rigcal::model::ControllerKind::none;
  Condition condition = condition_of("steps_4V", "");
  condition.moving_windows = true;
  condition.repeats = {
      {"steps_4V_1kHz.csv", {"01", "02", "03"}, {{Channel::position, "x_mm_A{n}"}}}};
  const Record record = load_record(campaign, condition);
  REQUIRE(record.windows.size() == 2);
  // According to the description of the data, steps come after 0.1 s and 5.1 s, with 200 mm at 205
  // and 146 mm/s.
  CHECK_THAT(record.windows[0].start_s, WithinAbs(0.10045, 1e-9));
  CHECK_THAT(record.windows[0].end_s, WithinAbs(1.05, 0.03));
  CHECK_THAT(record.windows[1].start_s, WithinAbs(5.10045, 1e-9));
  CHECK_THAT(record.windows[1].end_s, WithinAbs(6.45, 0.05));
}

TEST_CASE("load_record: decimation takes from a known sd what it takes from the noise",
          "[datasets]") {
  const TemporaryFolder files;
  std::string text = "t,x\n";
  for (int i = 0; i < 400; ++i)
    text += std::to_string(i) + "," + std::to_string(std::sin(0.01 * i)) + "\n";
  files.write("a.csv", text);
  Campaign campaign = campaign_in(files);
  campaign.channels[Channel::position].sd = 2e-5;
  campaign.decimate_to_hz = 250.0;
  const Record record = load_record(campaign, condition_of("a", "a.csv"));
  REQUIRE(record.time_s.size() == 100);
  CHECK_THAT(record.channels.at(Channel::position).sd_of_mean,
             WithinRel(2e-5 * anti_alias_filter(4).noise_gain(), 1e-12));
}
