#include "datasets/draft/draft_campaign.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "common/error.hpp"
#include "datasets/prepare/load_record.hpp"
#include "model/plant/parameter.hpp"
#include "tests/datasets/campaign_fixture.hpp"
#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/mat_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;

namespace {

namespace fs = std::filesystem;

/// Record of a loop that follows a sine of 2 Hz and 5 mm.
std::string sine_csv(double phase) {
  std::string text = "t_s,ref_mm,x_mm,note\n";
  for (int i = 0; i < 400; ++i) {
    const double t = 0.005 * i;
    const double angle = 12.566370614359172 * t;
    text += fmt::format("{},{},{},0\n", t, 5.0 * std::sin(angle),
                        4.8 * std::sin(angle - phase) + 0.01 * std::sin(31.0 * i));
  }
  return text;
}

/// Fills every blank with a value, as a user would do.
std::string filled(std::string text, model::PlantKind plant = model::PlantKind::load_pressure) {
  const auto fill = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
      text.replace(at, from.size(), to);
  };
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    if (spec.kind != model::ParameterKind::plant || spec.default_value) continue;
    const double value = spec.lower > 0.0 ? std::sqrt(spec.lower * spec.upper) : spec.lower;
    const std::string unit = spec.unit == "1" ? "" : " " + std::string(spec.unit);
    fill(fmt::format("{} = \"FILL IN{}\"", spec.key, unit),
         spec.unit == "1" ? fmt::format("{} = {:.1f}", spec.key, value)
                          : fmt::format("{} = \"{:e}{}\"", spec.key, value, unit));
  }
  fill("kp = \"FILL IN V/m\"", "kp = \"100 V/m\"");
  fill("lever = \"FILL IN m/rad\"", "lever = \"0.3 m/rad\"");
  fill("area_a = \"FILL IN m2\"", "area_a = \"40 cm2\"");
  fill("area_b = \"FILL IN m2\"", "area_b = \"24 cm2\"");
  fill("valve_gain = \"FILL IN m/V\"", "valve_gain = \"0.1 mm/V\"");
  fill("pilot_gain = \"FILL IN m/Pa\"", "pilot_gain = \"0.1 mm/bar\"");
  return text;
}

}  // namespace

TEST_CASE("draft_campaign: a reference in newtons makes a loop on force", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,ref_kN,F_kN,x_mm,acc_x\n";
  for (int i = 0; i < 400; ++i) {
    const double angle = 12.566370614359172 * 0.005 * i;
    text += fmt::format("{},{},{},{},{}\n", 0.005 * i, 2.0 * std::sin(angle),
                        1.9 * std::sin(angle - 0.1), 4.0 * std::sin(angle - 0.2), std::cos(angle));
  }
  const fs::path file = folder.write("bend.csv", text);
  std::string draft = draft_campaign({file}, folder.path()).text;
  CHECK_THAT(draft, Contains("feedback = \"force\""));
  CHECK_THAT(draft, Contains("force_reference = { column = \"ref_kN\", unit = \"kN\" }"));
  CHECK_THAT(draft, Contains("# payload_mass = "));  // because an acceleration was recorded
  CHECK_THAT(draft, Contains("amplitude = \"2 kN\"") && !Contains("three_variable"));
  draft = filled(draft);
  const auto fill = [&](const std::string& from, const std::string& to) {
    draft = replaced(draft, from, to);
  };
  fill("force_kp = \"FILL IN V/N\"", "force_kp = \"1 V/kN\"");
  fill("unit = \"FILL IN\"", "unit = \"m/s2\"");
  const Campaign campaign = load_campaign(folder.write("draft.toml", draft));
  CHECK(campaign.rig.feedback == model::Feedback::force);
  CHECK(campaign.conditions.front().amplitude == Approx(2000.0));
}

TEST_CASE("draft_campaign: a reference beside an accelerometer may be that of a shake table",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto drafted = [&](const std::string& header) {
    std::string text = header + "\n";
    for (int i = 0; i < 400; ++i) {
      const double angle = 12.566370614359172 * 0.005 * i;
      text += fmt::format("{},{},{},{}\n", 0.005 * i, 2.0 * std::sin(angle),
                          1.9 * std::sin(angle - 0.1), std::cos(angle));
    }
    return draft_campaign({folder.write("table.csv", text)}, folder.path()).text;
  };
  CHECK_THAT(
      drafted("t_s,ref_mm,x_mm,acc [m/s2]"),
      Contains("# feedback = \"three_variable\"  # the controller of many shake tables: with "
               "kp, velocity_kp, acceleration_kp, reference_frequency, "
               "reference_damping_ratio"));
  CHECK_THAT(drafted("t_s,ref_mm,x_mm,force_N"), !Contains("three_variable"));
}

TEST_CASE("draft_campaign: ticks of 100 ns, a count of samples, and values that are not exact",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string ticks = "Time[100ns],x_mm,Time[100ns],u_V\n";
  std::string counts = "Nr;x_mm;u_V\n";
  for (int i = 0; i < 20; ++i) {
    ticks += fmt::format("{0},{1},{0},{2}\n", 133507764000000000 + 10000L * i, i % 5, i % 3);
    counts += fmt::format("{};{};{}\n", i, i % 5, i % 3);
  }
  const std::string of_ticks =
      draft_campaign({folder.write("ticks.csv", ticks)}, folder.path()).text;
  CHECK_THAT(of_ticks, Contains("column = \"Time[100ns]\", unit = \"us\", gain = 0.1 }") &&
                           Contains("20 samples at 1000"));
  CHECK_THAT(of_ticks, Contains("counts as exact unless") && Contains("prior_sd = ..."));
  CHECK_THAT(draft_campaign({folder.write("counts.csv", counts)}, folder.path()).text,
             Contains("perhaps 'Nr'") && Contains("a count of samples needs gain = ..."));
}

TEST_CASE("draft_campaign: an angle makes a linkage, and its pilot pressures one drive",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string text =
      "t_s,p_head_bar,p_rod_bar,duty_arm_in_pct,duty_arm_out_pct,pilot_arm_in_bar,"
      "pilot_arm_out_bar,angle_deg\n";
  for (int i = 0; i < 200; ++i) {
    const bool moves = i > 50;
    text += fmt::format("{},{},20,{},0,{},0.2,{}\n", 0.01 * i, 30 + 0.01 * i, moves ? 60 : 0,
                        moves ? 18.0 : 0.1, moves ? -30.0 - 0.1 * (i - 50) : -30.0);
  }
  const fs::path file = folder.write("arm.csv", text);
  std::string draft = draft_campaign({file}, folder.path()).text;
  CHECK_THAT(draft, Contains("model = \"linkage\""));
  CHECK_THAT(draft, Contains("angle = { column = \"angle_deg\", unit = \"deg\" }"));
  CHECK_THAT(draft, Contains("pilot_pressure = { column = \"pilot_arm_out_bar\", minus = "
                             "\"pilot_arm_in_bar\", unit = \"bar\" }"));
  CHECK_THAT(draft, Contains("# 'duty_arm_in_pct' also looks like a drive"));
  CHECK_THAT(draft, Contains("# pilot_dead_band = ") && Contains("# bypass_opening = "));
  CHECK_THAT(draft, Contains("# pump_second_flow = ") && Contains("# relief_pressure = ") &&
                        Contains("# gravity_moment_curvature = "));
  CHECK_THAT(draft, Contains("initial = \"record\""));
  draft = filled(draft, model::PlantKind::linkage);
  for (const auto& [key, value] :
       {std::pair("lower_stop", "-3"), std::pair("upper_stop", "-0.5")}) {
    const auto at = draft.find(fmt::format("\n{} = ", key)) + 1;
    draft.replace(at, draft.find('\n', at) - at, fmt::format("{} = \"{} rad\"", key, value));
  }
  const Campaign campaign = load_campaign(folder.write("draft.toml", draft));
  CHECK(campaign.rig.pilot);
  const Record record = load_record(campaign, campaign.conditions.at(0));
  CHECK(record.channels.at(Channel::pilot_pressure).mean.back() == Approx((0.2 - 18.0) * 1e5));
}

TEST_CASE("draft_campaign: a pilot pressure drives a cylinder of two chambers, unless a loop does",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,pilot_out_bar,pilot_in_bar,u_V,x_mm\n";
  std::string loop = "t_s,pilot_out_bar,ref_mm,x_mm,p_A_bar\n";
  for (int i = 0; i < 200; ++i) {
    text +=
        fmt::format("{},{},0.2,{},{}\n", 0.01 * i, i > 50 ? 18.0 : 0.1, i > 50 ? 4 : 0, 0.1 * i);
    loop += fmt::format("{},{},{},{},80\n", 0.01 * i, i > 50 ? 18.0 : 0.1, 0.1 * i, 0.1 * i);
  }
  std::string draft = draft_campaign({folder.write("boom.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("model = \"two_chamber\""));
  CHECK_THAT(draft, Contains("pilot_pressure = { column = \"pilot_out_bar\", minus = "
                             "\"pilot_in_bar\", unit = \"bar\" }"));
  CHECK_THAT(draft, Contains("# 'u_V' also looks like a drive"));
  CHECK_THAT(draft, Contains("# load_sensing_margin = ") && Contains("# return_exponent = "));
  CHECK_THAT(draft, !Contains("valve_dead_band"));  // it is in volts
  draft = filled(draft, model::PlantKind::two_chamber);
  const Campaign campaign = load_campaign(folder.write("draft.toml", draft));
  CHECK(campaign.rig.pilot);
  CHECK(drive_channel(campaign) == Channel::pilot_pressure);

  draft = draft_campaign({folder.write("loop.csv", loop)}, folder.path()).text;
  CHECK_THAT(draft, Contains("# 'pilot_out_bar' looks like a pilot pressure, but a rig with a "
                             "controller has a reference"));
  CHECK_THAT(draft, Contains("\nvalve_gain = ") && !Contains("pilot_gain"));
}

TEST_CASE("draft_campaign: a joint without a pilot has an electric valve", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,angle_deg,u_up_V,u_down_V\n";
  for (int i = 0; i < 200; ++i)
    text += fmt::format("{},{},{},0\n", 0.01 * i, i > 50 ? 0.1 * i : 5.0, i > 50 ? 4 : 0);
  const std::string draft = draft_campaign({folder.write("j.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("model = \"linkage\""));
  CHECK_THAT(draft, Contains("\nvalve_gain = \"FILL IN m/V\""));
  CHECK_THAT(draft, Contains("column = \"u_up_V\", minus = \"u_down_V\""));
  CHECK_THAT(draft, !Contains("pilot_dead_band"));
}

TEST_CASE("draft_campaign: a reference beside an angle makes a loop on the angle", "[datasets]") {
  for (const char* reference : {"ref_deg", "ref"}) {
    CAPTURE(reference);
    const TemporaryFolder folder;
    std::string text = fmt::format("t_s,{},angle_deg,pA_bar,pB_bar\n", reference);
    for (int i = 0; i < 200; ++i)
      text += fmt::format("{},{},{},{},20\n", 0.01 * i, i > 50 ? 10 : 0, i > 50 ? 0.05 * i : 0.0,
                          80 + i % 3);
    const std::string draft = draft_campaign({folder.write("j.csv", text)}, folder.path()).text;
    CHECK_THAT(draft, Contains("model = \"linkage\"") && Contains("type = \"pid\""));
    CHECK_THAT(draft,
               Contains("feedback = \"angle\"  # what the loop controls; angle unless given"));
    CHECK_THAT(draft, Contains("\nangle_kp = \"FILL IN V/rad\"") &&
                          Contains("# pressure_feedback = \"... V/Pa\"") &&
                          Contains("\n# angular_velocity_feedforward = \"... V s/rad\"") &&
                          !Contains("# velocity_feedforward"));
    CHECK_THAT(draft, Contains(fmt::format("angle_reference = {{ column = \"{}\"", reference)));
    CHECK_THAT(draft, Contains("\nvalve_gain = ") && !Contains("\nreference = "));
  }
}

TEST_CASE("draft_campaign: the reference of a torque or a pressure makes that loop of a joint",
          "[datasets]") {
  struct Row {
    const char* header;
    const char* feedback;
    const char* gain;
    const char* reference;
  };
  for (const Row& row :
       {Row{"t_s,M_soll_Nm,angle_deg,M_ist_Nm", "torque", "\ntorque_kp = \"FILL IN V/(N m)\"",
            "\ntorque_reference = { column = \"M_soll_Nm\", unit = \"N m\" }"},
        Row{"t_s,M_soll_Nm,pA_bar,M_ist_Nm", "torque", "\ntorque_kp = \"FILL IN V/(N m)\"",
            "\ntorque = { column = \"M_ist_Nm\", unit = \"N m\" }"},
        Row{"t_s,p_ref_bar,angle_deg,pA_bar", "load_pressure",
            "\nload_pressure_kp = \"FILL IN V/Pa\"",
            "\nload_pressure_reference = { column = \"p_ref_bar\", unit = \"bar\" }"},
        Row{"t_s,p_ref_bar,angle_deg,ref_deg", "angle", "\nangle_kp = \"FILL IN V/rad\"",
            "\nangle_reference = { column = \"ref_deg\""}}) {
    CAPTURE(row.header);
    const TemporaryFolder folder;
    std::string text = std::string(row.header) + "\n";
    for (int i = 0; i < 200; ++i)
      text += fmt::format("{},{},{},{}\n", 0.01 * i, i > 50 ? 100 : 0, 0.1 * i, 20.0 + 0.3 * i);
    const std::string draft = draft_campaign({folder.write("j.csv", text)}, folder.path()).text;
    CHECK_THAT(draft, Contains("model = \"linkage\"") && Contains("type = \"pid\""));
    CHECK_THAT(draft, Contains(fmt::format("\nfeedback = \"{}\"", row.feedback)));
    CHECK_THAT(draft, Contains(row.gain) && Contains(row.reference));
  }
}

TEST_CASE("draft_campaign: a joint may have a torque, and a slide has none", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,u_V,angle_deg,torque_Nm\n";
  for (int i = 0; i < 200; ++i)
    text += fmt::format("{},{},{},{}\n", 0.01 * i, i > 50 ? 4 : 0, 0.1 * i, 20.0 + 0.3 * i);
  std::string draft = draft_campaign({folder.write("j.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("\ntorque = { column = \"torque_Nm\", unit = \"N m\" }  # ") &&
                        Contains("role = \"input\" if it is a load"));
  CHECK_THAT(draft, Contains("displacement_per_radian, such as \"50 cm3/rev\""));
  text.replace(text.find("angle_deg"), 9, "x_mm");
  draft = draft_campaign({folder.write("s.csv", text)}, folder.path()).text;
  CHECK_THAT(draft,
             Contains("# 'torque_Nm' looks like torque, but no column looks like an angle") &&
                 !Contains("\ntorque = "));
}

TEST_CASE("draft_campaign: a load from outside is an input, in the direction of the rig's motion",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,u_V,x_mm,F_ext_kN\n";
  for (int i = 0; i < 200; ++i)
    text += fmt::format("{},{},{},{}\n", 0.01 * i, i > 50 ? 4 : 0, 0.1 * i, 20.0 + 0.3 * (i % 7));
  std::string draft = draft_campaign({folder.write("s.csv", text)}, folder.path()).text;
  CHECK_THAT(draft,
             Contains("\nforce = { column = \"F_ext_kN\", unit = \"kN\", role = \"input\" }  # "));
  std::string cell = text;
  cell.replace(cell.find("F_ext_kN"), 8, "F_ist_kN");
  draft = draft_campaign({folder.write("c.csv", cell)}, folder.path()).text;
  CHECK_THAT(draft, Contains("\nforce = { column = \"F_ist_kN\", unit = \"kN\" }  # ") &&
                        Contains("role = \"input\" if it is a load"));
  // The loop has this force as its own.
  cell.replace(cell.find("F_ist_kN"), 8, "F_ext_kN");
  cell.replace(cell.find("u_V"), 3, "F_soll_kN");
  draft = draft_campaign({folder.write("l.csv", cell)}, folder.path()).text;
  CHECK_THAT(draft,
             Contains("\nforce = { column = \"F_ext_kN\"") && !Contains("role = \"input\" }"));
  // A joint has a moment, and no channel of a slide.
  text.replace(text.find("x_mm,F_ext_kN"), 13, "angle_deg,M_ext_Nm");
  draft = draft_campaign({folder.write("j.csv", text)}, folder.path()).text;
  CHECK_THAT(
      draft,
      Contains("\ntorque = { column = \"M_ext_Nm\", unit = \"N m\", role = \"input\" }  # "));
  text.replace(text.find("M_ext_Nm"), 8, "F_ext_kN");
  draft = draft_campaign({folder.write("f.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("# 'F_ext_kN' looks like force, but the rig turns an arm") &&
                        !Contains("\nforce = "));
}

TEST_CASE("draft_campaign: a square wave of a simulation program is a generated one",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,ref_m,x_m\n";
  for (int i = 0; i < 3001; ++i) {
    const bool late = i == 300 || i == 1100;  // an edge on which the solver has the old value
    const int half = (late ? i - 1 : i) / 50;
    text += fmt::format("{:.3f},{},{}\n", 0.001 * i,
                        i == 0          ? 0.0
                        : half % 2 == 0 ? 0.002
                                        : -0.002,
                        1e-5 * (i % 11));
  }
  const std::string draft = draft_campaign({folder.write("h.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("\nwaveform = \"square\"\n") && Contains("frequency = \"10 Hz\"") &&
                        Contains("amplitude = \"0.002 m\""));
}

TEST_CASE("draft_campaign: both pressures and a position suggest a load by a table", "[datasets]") {
  const TemporaryFolder folder;
  std::string both = "t_s,u_V,x_mm,pA_bar,pB_bar,acc_base [m/s2]\n";
  std::string one = "t_s,u_V,x_mm,pA_bar\n";
  for (int i = 0; i < 200; ++i) {
    both += fmt::format("{},{},{},80,20,{}\n", 0.01 * i, i > 50 ? 4 : 0, 0.1 * i, 0.01 * (i % 7));
    one += fmt::format("{},{},{},80\n", 0.01 * i, i > 50 ? 4 : 0, 0.1 * i);
  }
  const std::string draft = draft_campaign({folder.write("both.csv", both)}, folder.path()).text;
  CHECK_THAT(draft, Contains("# load_table_from = \"... m\"") && Contains("# load_0 = \"... N\"") &&
                        Contains("# load_100 = "));
  CHECK_THAT(draft, Contains("base_acceleration = { column = \"acc_base [m/s2]\", unit = "));
  CHECK_THAT(draft_campaign({folder.write("one.csv", one)}, folder.path()).text,
             !Contains("load_table_from"));
}

TEST_CASE("draft_campaign: repeats, waveform and columns, and loads once it is filled",
          "[datasets]") {
  const TemporaryFolder folder;
  for (const std::string n : {"1", "2", "3"})
    folder.write("records/sine_" + n + ".csv", sine_csv(0.1));
  const fs::path records = folder.path() / "records";
  const std::string draft =
      draft_campaign({records / "sine_1.csv", records / "sine_2.csv", records / "sine_3.csv"},
                     folder.path() / "draft")
          .text;
  CHECK_THAT(draft, Contains("time = { column = \"t_s\", unit = \"s\" }"));
  CHECK_THAT(draft, Contains("reference = { column = \"ref_mm\", unit = \"mm\" }"));
  CHECK_THAT(draft, Contains("position = { column = \"x_mm\", unit = \"mm\" }"));
  CHECK_THAT(draft, Contains("# FILL IN = { column = \"note\", unit = \"FILL IN\" }  # 0 to 0, "
                             "constant"));
  CHECK_THAT(draft, Contains("id = \"sine\"") && Contains("waveform = \"sine\""));
  CHECK_THAT(draft, Contains("frequency = \"2 Hz\"") && Contains("amplitude = \"5 mm\""));
  CHECK_THAT(draft, Contains("400 samples at 200 Hz"));
  CHECK_THAT(draft, Contains("\"../records/sine_1.csv\"") && Contains("type = \"pid\""));
  CHECK_THAT(draft, Contains("initial = \"fit\"  # estimated: sine moves within its first 0.1 s"));

  const fs::path file = folder.write("draft/campaign.toml", draft);
  CHECK_THROWS_WITH(load_campaign(file), Contains("FILL IN"));
  const Campaign campaign = load_campaign(folder.write("draft/campaign.toml", filled(draft)));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  CHECK(record.repeats == 3);
  CHECK(record.channels.contains(Channel::position));
}

TEST_CASE("draft_campaign: a drive is generated only if its samples are", "[datasets]") {
  const auto waveform = [](const char* header, double (*reference)(double)) {
    const TemporaryFolder folder;
    std::string text = header;
    for (int i = 0; i < 400; ++i)
      text += fmt::format("{},{},{}\n", 0.005 * i, reference(0.005 * i),
                          4.8 * std::sin(12.566370614359172 * 0.005 * i - 0.1));
    return draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  };
  constexpr double kTwoHz = 12.566370614359172;  // rad/s
  const char* mm = "t_s,ref_mm,x_mm\n";
  CHECK_THAT(waveform(mm, [](double t) { return 5.0 * std::sin(kTwoHz * t); }),
             Contains("waveform = \"sine\""));
  // A phase of 4 ms, a triangle, and a frequency of more digits than the draft shows.
  for (const auto reference : {+[](double t) { return 5.0 * std::sin(kTwoHz * t - 0.05); },
                               +[](double t) { return 5.0 * std::asin(std::sin(kTwoHz * t)); },
                               +[](double t) { return 5.0 * std::sin(1.0002 * kTwoHz * t); }})
    CHECK_THAT(waveform(mm, reference),
               Contains("waveform = \"recorded\"  # not simulated as generated") &&
                   !Contains("FILL IN mm"));
  // A reference in volts has an amplitude in metres only after its gain.
  CHECK_THAT(waveform("t_s,ref_V,x_mm\n", [](double t) { return 5.0 * std::sin(kTwoHz * t); }),
             Contains("waveform = \"recorded\"") && !Contains("amplitude = "));
}

TEST_CASE("draft_campaign: a column with few numbers is a comment", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,ref_mm,x_mm,T_oil_C\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{},{},{},{}\n", 0.005 * i, i % 7, i % 5, i % 50 == 0 ? "41.5" : "");
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, !Contains("\ntemperature = ") && !Contains("a campaign rejects"));
  CHECK_THAT(draft, Contains("# FILL IN = { column = \"T_oil_C\"") &&
                        Contains("a number in 8 of 400 rows"));
}

TEST_CASE("draft_campaign: one column per repeat, two sets, no loop", "[datasets]") {
  const TemporaryFolder folder;
  std::string text =
      "t_s,u_V,x_mm_A01,pA_bar_01,x_mm_A02,pA_bar_02,x_mm_B01,pB_bar_01,x_mm_B02,"
      "pB_bar_02\n";
  for (int i = 0; i < 300; ++i) {
    const double x = std::clamp(0.5 * (i - 50), 0.0, 60.0);
    text += fmt::format("{},{},{},1{},{},1{},{},2{},{},2{}\n", 0.01 * i, i < 50 ? 0 : 2, x, i, x, i,
                        x, i, x, i);
  }
  const fs::path file = folder.write("steps_2V.csv", text);
  const std::string draft = draft_campaign({file}, folder.path()).text;
  CHECK_THAT(draft, Contains("position = { unit = \"mm\" }"));
  CHECK_THAT(draft, Contains("command = { column = \"u_V\", unit = \"V\" }"));
  CHECK_THAT(draft, Contains("{ file = \"steps_2V.csv\", n = \"01..02\", columns = { position = "
                             "\"x_mm_A{n}\", pressure_a = \"pA_bar_{n}\" } }"));
  CHECK_THAT(draft, Contains("position = \"x_mm_B{n}\", pressure_b = \"pB_bar_{n}\""));
  CHECK_THAT(draft, Contains("waveform = \"recorded\"") && Contains("type = \"none\""));
  // Chamber pressures select the plant with two chambers.
  CHECK_THAT(draft, Contains("model = \"two_chamber\"") && Contains("area_b = \"FILL IN m2\"") &&
                        Contains("# retracted_position = \"... m\"  # x_R: "));
  CHECK_THAT(draft, !Contains("piston_area"));
  const Campaign campaign =
      load_campaign(folder.write("campaign.toml", filled(draft, model::PlantKind::two_chamber)));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  CHECK(record.repeats == 4);
  CHECK(record.channels.at(Channel::pressure_b).repeats == 2);
}

TEST_CASE("draft_campaign: a MAT file, and a column in volts", "[datasets]") {
  const TemporaryFolder folder;
  std::vector<double> t;
  std::vector<double> u;
  for (int i = 0; i < 200; ++i) {
    t.push_back(0.01 * i);
    u.push_back(3.0 * std::sin(0.2 * i) + 1.0);
  }
  write_mat(folder.path() / "run.mat", MatFormat::v7,
            {mat_struct(
                "log", {{mat_array("time", t), mat_array("u_V", u), mat_array("position_V", u)}})});
  const std::string draft = draft_campaign({folder.path() / "run.mat"}, folder.path()).text;
  CHECK_THAT(draft, Contains("time = { column = \"log.time\""));
  CHECK_THAT(draft, Contains("command = { column = \"log.u_V\", unit = \"V\" }"));
  CHECK_THAT(draft, Contains("position = { column = \"log.position_V\", unit = \"FILL IN\" }") &&
                        Contains("the column is in V"));
  CHECK_THAT(draft, Contains("not simulated as generated: its samples show an offset, a phase"));
}

TEST_CASE("draft_campaign: a summary beside the recordings is left out", "[datasets]") {
  const TemporaryFolder folder;
  const fs::path summary = folder.write("summary.csv", "run,speed_mm_s\n1,2\n");
  const fs::path run = folder.write("sine_1.csv", sine_csv(0.1));
  const auto [draft, left_out] = draft_campaign({summary, run}, folder.path());
  REQUIRE(left_out.size() == 1);
  CHECK_THAT(left_out[0], Contains("summary.csv (no column looks like a time"));
  CHECK_THAT(draft, Contains("# left out: summary.csv (no column looks like a time"));
  CHECK_THAT(draft, !Contains("id = \"summary\"") && Contains("\"sine_1.csv\""));
  CHECK_THAT(draft, Contains("model = \"load_pressure\""));
}

TEST_CASE("draft_campaign: every draft is TOML and has each channel once", "[datasets]") {
  const std::vector<std::string> headers{
      "sample,ref_mm,x_l_mm,x_r_mm",  // two positions and no time
      "t,ref_mm,x_l_mm,x_r_mm",
      "t,u_V,x_mm,y_mm,pA_bar,p1_bar,p_cap_bar",
      "sample,cmd,lvdt",
      "sample,ref,cmd,drive",
      "t_s,pilot_out_bar,pilot_in_bar,u_V,x_mm",
      "n,pilot_out_bar,pilot_in_bar,u_V,x_mm",
      "n,u_up_V,u_down_V,angle_deg,theta",
      "n,ref_mm,pilot_bar,x_mm",
      "t,\"a \"\"quoted\"\" name\",x\\y_mm,\x01 [mm]",
      "t_s,x_1,x_2,x_3",
      "n,x_1,x_2,x_3",
      "n,x_1,x_2,y_1,y_2",
      "Zeit;Soll;Ist;Weg",
      "a,b,c",
      "X_Axis,ref_mm,pos_mm",
      "t,F_kN,force_N,load_N,ref_kN,cmd_kN",
      "t,t_2,time,x",
      "t,T_degC,temp,x_mm,acc_x,acc_y,acc_base_x,acc_base_y"};
  for (const std::string& header : headers) {
    CAPTURE(header);
    const TemporaryFolder folder;
    std::string text = header + "\n";
    const char separator = header.find(';') == std::string::npos ? ',' : ';';
    const auto columns = std::count(header.begin(), header.end(), separator) + 1;
    for (int i = 0; i < 20; ++i)
      for (long k = 0; k < columns; ++k)
        text += fmt::format("{}{}", k == 0 ? 0.5 * i : std::sin(0.3 * i + static_cast<double>(k)),
                            k + 1 < columns ? separator : '\n');
    std::string draft;
    try {
      draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
    } catch (const InputError&) {
      continue;  // refused, as a header with control characters is
    }
    // A channel that occurs twice, or a comment that has ended, is invalid.
    CHECK_NOTHROW(toml::parse(draft));
  }
}

TEST_CASE("draft_campaign: names with control characters do not end a comment", "[datasets]") {
  const TemporaryFolder folder;
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(0.1 * i);
  const fs::path path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    for (const char* name : {"/t", "/x", "/x\ny", "/odd\nname = 1"})
      file.array(name, values, {values.size()});
  }
  CHECK_NOTHROW(toml::parse(draft_campaign({path}, folder.path()).text));
}

TEST_CASE("draft_campaign: conditions have ids of their own", "[datasets]") {
  const TemporaryFolder folder;
  const std::string text = sine_csv(0.1);
  const std::string draft =
      draft_campaign({folder.write("a-.csv", text), folder.write("a-.txt", text),
                      folder.write("a-2x.csv", text), folder.write("a-2x.txt", text),
                      folder.write("a-2x-2.csv", text)},
                     folder.path())
          .text;
  const auto parsed = toml::parse(draft);
  std::vector<std::string> ids;
  for (const auto& condition : *parsed["condition"].as_array())
    ids.push_back(condition.at_path("id").value_or(std::string()));
  REQUIRE(ids.size() == 5);
  std::sort(ids.begin(), ids.end());
  CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
}

TEST_CASE("draft_campaign: a file whose time restarts is left out", "[datasets]") {
  const TemporaryFolder folder;
  const std::string restarts = "t_s,u_V,x_mm\n0,1,0\n0.1,1,1\n0,1,0\n0.1,1,1\n";
  const fs::path cuts = folder.write("cuts.csv", restarts);
  const fs::path run = folder.write("sine_2.csv", sine_csv(0.1));
  const std::string draft = draft_campaign({cuts, run}, folder.path()).text;
  CHECK_THAT(draft, Contains("# left out: cuts.csv:4:1: time 't_s' does not increase"));
  CHECK_THAT(draft, !Contains("id = \"cuts\"") && Contains("\"sine_2.csv\""));
  // The first of two repeats is unreadable, so the second one replaces it.
  const std::string rest =
      draft_campaign({folder.write("sine_1.csv", restarts), run}, folder.path()).text;
  CHECK_THAT(rest,
             Contains("# left out: sine_1.csv:4:1") && Contains("repeats = [ \"sine_2.csv\" ]"));
  CHECK_THROWS_WITH(draft_campaign({cuts}, folder.path()), Contains("cuts.csv:4:1: time 't_s'"));
}

TEST_CASE("draft_campaign: files that tell nothing", "[datasets]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(draft_campaign({folder.write("a.csv", "block,x_mm\n1,2\n")}, folder.path()),
                    Contains("a.csv: no column looks like a time") && Contains("block, x_mm"));
  CHECK_THROWS_WITH(draft_campaign({folder.write("b.csv", "t,q\n1,2\n")}, folder.path()),
                    Contains("b.csv: no column looks like a channel"));
  CHECK_THROWS_AS(draft_campaign({folder.path() / "none.csv"}, folder.path()), InputError);
}

TEST_CASE("draft_campaign: from a text as a German logger writes it", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "Pruefstand 3;;\nDatum;12.3.2026;\n\nZeit;Sollwert;Weg;Kanal 7\ns;mm;mm;bar\n";
  for (int i = 0; i < 400; ++i) {
    const double angle = 12.566370614359172 * 0.005 * i;
    std::string row = fmt::format("{};{};{};{}\n", 0.005 * i, 5.0 * std::sin(angle),
                                  4.8 * std::sin(angle - 0.1), 3.5 + 0.5 * std::sin(angle));
    std::replace(row.begin(), row.end(), '.', ',');
    text += row;
  }
  const std::string draft = draft_campaign({folder.write("lauf_1.txt", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("time = { column = \"Zeit\", unit = \"s\" }"));
  CHECK_THAT(draft, Contains("reference = { column = \"Sollwert\", unit = \"mm\" }"));
  CHECK_THAT(draft, Contains("position = { column = \"Weg\", unit = \"mm\" }"));
  CHECK_THAT(draft, Contains("# FILL IN = { column = \"Kanal 7\", unit = \"bar\" }  # 3") &&
                        Contains("bar, perhaps pressure_a"));
  CHECK_THAT(draft, Contains("# transport_delay = ") && Contains("# external_force = ") &&
                        Contains("# ki = ") && Contains("# before = \"rest\""));
  const Campaign campaign = load_campaign(folder.write("campaign.toml", filled(draft)));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  REQUIRE(record.time_s.size() == 400);
  CHECK_THAT(record.time_s[7], Catch::WithinAbs(0.035, 1e-12));
}

TEST_CASE("draft_campaign: columns that nothing recognises, with their ranges", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "A1,Q [bar],note\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{},{},ok\n", 0.5 * i, 3 + i % 4);
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("time = { column = \"FILL IN\", unit = \"s\" }") &&
                        Contains("position = { column = \"FILL IN\", unit = \"FILL IN\" }"));
  CHECK_THAT(draft,
             Contains("# perhaps 'A1' (0 to 9.5); a count of samples needs gain") &&
                 Contains("{ column = \"A1\", unit = \"FILL IN\" }  # 0 to 9.5, perhaps time") &&
                 Contains("unit = \"bar\" }  # 3 to 6 bar, perhaps pressure_a") &&
                 Contains("# not columns of numbers: note\n"));
  // If there is also a proper recording, the file does not count as one.
  const Draft both = draft_campaign(
      {folder.path() / "a.csv", folder.write("s_1.csv", sine_csv(0.1))}, folder.path());
  REQUIRE(both.left_out.size() == 1);
  CHECK_THAT(both.left_out[0], Contains("a.csv (no column looks like a time"));
}

TEST_CASE("draft_campaign: a motion or drive that no name identifies is a blank", "[datasets]") {
  const TemporaryFolder folder;
  const auto drafted = [&](const std::string& header) {
    std::string text = header + "\n";
    for (int i = 0; i < 100; ++i)
      text += fmt::format("{},{},{},{}\n", 0.01 * i, std::sin(0.2 * i), 2.0 + std::sin(0.2 * i),
                          0.1 * (i % 7));
    return draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  };
  const std::string blank = "{ column = \"FILL IN\", unit = \"FILL IN\" }";
  std::string draft = drafted("t_s,ref_mm,ch1 [mm],ch2 [bar]");
  CHECK_THAT(draft, Contains("\nposition = " + blank + "  # perhaps 'ch1 [mm]' (1"));
  CHECK_THAT(draft, !Contains("command = "));

  draft = drafted("t_s,x_mm,ch1,ch2 [bar]");
  CHECK_THAT(draft,
             !Contains("position = { column = \"FILL IN") && Contains("\ncommand = " + blank));
  // Filled in as its comments say, it is a campaign.
  draft =
      replaced(filled(draft), "command = " + blank, "command = { column = \"ch1\", unit = \"V\" }");
  draft = replaced(draft, "waveform = \"FILL IN\"", "waveform = \"recorded\"");
  const Campaign campaign = load_campaign(folder.write("campaign.toml", draft));
  CHECK(load_record(campaign, campaign.conditions.at(0)).time_s.size() == 100);

  // Nothing is left that could be either.
  draft = drafted("t_s,x_mm,v_mm/s,err_mm");
  CHECK_THAT(draft, !Contains("\ncommand = ") && Contains("mm/s, a velocity") &&
                        Contains("a control error"));
}

TEST_CASE("draft_campaign: a command in percent or milliamperes has a full scale", "[datasets]") {
  const TemporaryFolder folder;
  const auto drafted = [&](const std::string& header) {
    std::string text = header + "\n";
    for (int i = 0; i < 50; ++i) text += fmt::format("{},{},{}\n", i, i % 5, i % 7);
    return draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  };
  CHECK_THAT(drafted("t_s,duty_pct,x_mm"),
             Contains("command = { column = \"duty_pct\", unit = \"%\" }\n"));
  CHECK_THAT(drafted("t_s,Ventilstrom_mA,x_mm"),
             Contains("command = { column = \"Ventilstrom_mA\", unit = \"mA\", full_scale = "
                      "\"FILL IN mA\" }"));
  // No other channel has one.
  CHECK_THAT(drafted("t_s,u_V,position_%"),
             Contains("position = { column = \"position_%\", unit = \"FILL IN\" }"));
}

TEST_CASE("draft_campaign: a second unknown pressure is that of the other chamber", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,u_V,x_mm,ch 7 [bar],ch 8 [bar],ch 9 [bar]\n";
  for (int i = 0; i < 50; ++i)
    text += fmt::format("{},1,{},{},{},{}\n", i, i % 5, 40 + i % 7, 60 - i % 7, 100 + i % 3);
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft,
             Contains("\"ch 7 [bar]\", unit = \"bar\" }  # 40 to 46 bar, perhaps pressure_a"));
  CHECK_THAT(draft,
             Contains("\"ch 8 [bar]\", unit = \"bar\" }  # 54 to 60 bar, perhaps pressure_b"));
  CHECK_THAT(draft, Contains("perhaps supply_pressure"));
}

TEST_CASE("draft_campaign: numbers that nothing names", "[datasets]") {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{:10.4f} {:10.4f} {:10.4f}\n", 0.005 * i, std::sin(0.3 * i),
                        5.0 * std::sin(0.3 * i - 0.5));
  std::string draft = draft_campaign({folder.write("run.dat", text)}, folder.path()).text;
  CHECK_THAT(draft,
             Contains("\ntime = { column = \"FILL IN\", unit = \"s\" }  # perhaps '1' (0 to "));
  CHECK_THAT(draft, Contains("perhaps '2' (-") && Contains(" or '3' (-"));
  draft = replaced(filled(draft), "time = { column = \"FILL IN\"", "time = { column = \"1\"");
  draft = replaced(draft, "position = { column = \"FILL IN\", unit = \"FILL IN\"",
                   "position = { column = \"3\", unit = \"mm\"");
  draft = replaced(draft, "command = { column = \"FILL IN\", unit = \"FILL IN\"",
                   "command = { column = \"2\", unit = \"V\"");
  draft = replaced(draft, "waveform = \"FILL IN\"", "waveform = \"recorded\"");
  const Campaign campaign = load_campaign(folder.write("campaign.toml", draft));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  REQUIRE(record.time_s.size() == 100);
  CHECK(record.time_s[1] == Approx(0.005));
}

TEST_CASE("draft_campaign: rows without a number are told, and the draft is made", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t_s,ref_mm,x_mm\n";
  for (int i = 0; i < 200; ++i)
    text += i == 50 ? "0.25,1,NaN\n"
                    : fmt::format("{},{},{}\n", 0.005 * i, i > 20 ? 1 : 0,
                                  i == 70 ? std::string() : std::to_string(0.01 * i));
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("# a campaign rejects a.csv: 2 rows without a number: line 52 has "
                             "'NaN' in column 'x_mm'"));
  CHECK_THAT(draft, Contains("# holes = \"bridge\"") && Contains("position = { column = \"x_mm\""));
  const Campaign campaign = load_campaign(folder.write("campaign.toml", filled(draft)));
  CHECK_THROWS_WITH(load_record(campaign, campaign.conditions.at(0)), Contains("a.csv:52:"));
}

TEST_CASE("draft_campaign: columns of one name cannot be read, and the draft says so",
          "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "t,ref_mm,x,x\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{},{},{}\n", i, i % 3, i % 5, i % 7);
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("# several columns are named 'x'") &&
                        Contains("\nposition = { column = \"FILL IN\""));
}

TEST_CASE("draft_campaign: a clock as time", "[datasets]") {
  const TemporaryFolder folder;
  std::string text = "Timestamp,Setpoint_mm,Position_mm\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("2024-02-29 23:59:59.{:03},{},{}\n", 5 * i, i > 9 ? 1 : 0, 0.01 * i);
  text += "2024-03-01T00:00:00.000,1,1\n";
  const std::string draft = draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  CHECK_THAT(draft, Contains("101 samples at"));
  const Campaign campaign = load_campaign(folder.write("campaign.toml", filled(draft)));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  CHECK_THAT(record.time_s.at(1) - record.time_s.at(0), Catch::WithinAbs(0.005, 1e-9));
  CHECK_THAT(record.time_s.back() - record.time_s.at(0), Catch::WithinAbs(1.0, 1e-9));
}

TEST_CASE("draft_campaign: the channels suggest terms of valve, supply, load and loop",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto drafted = [&](const std::string& header) {
    std::string text = header + "\n";
    const auto columns = std::count(header.begin(), header.end(), ',');
    for (int i = 0; i < 100; ++i) {
      text += fmt::format("{}", 0.01 * i);
      for (long k = 0; k < columns; ++k) text += fmt::format(",{}", std::sin(0.2 * i) + 3.0);
      text += "\n";
    }
    return draft_campaign({folder.write("a.csv", text)}, folder.path()).text;
  };
  const auto offers = [](const std::string& draft, const std::string& key) {
    return draft.find("\n# " + key + " = ") != std::string::npos;
  };
  const std::string loop = drafted("t,ref_mm,x_mm,pl_bar");
  const std::string bare_loop = drafted("t,ref_mm,x_mm");
  for (const char* key : {"pressure_feedback", "leakage_resistance", "seal_friction",
                          "load_gradient", "load_curvature"}) {
    CAPTURE(key);
    CHECK(offers(loop, key));
    CHECK_FALSE(offers(bare_loop, key));
  }
  for (const char* key : {"velocity_feedforward", "acceleration_feedforward"})
    CHECK(offers(bare_loop, key));
  const std::string supplied = drafted("t,ref_mm,x_mm,pl_bar,ps_bar");
  for (const char* key : {"supply_resistance", "pump_flow", "accumulator_volume"})
    CHECK((offers(supplied, key) && !offers(loop, key)));
  CHECK_FALSE(offers(supplied, "load_sensing_margin"));

  const std::string open = drafted("t,u_V,x_mm,pA_bar,pB_bar,ps_bar,spool_mm");
  for (const char* key : {"valve_exponent", "opening_20", "compensator_pressure", "main_spool_gain",
                          "accumulator_volume", "pump_second_flow", "supply_resistance",
                          "load_sensing_margin", "seal_friction", "load_curvature"}) {
    CAPTURE(key);
    CHECK(offers(open, key));
  }
  CHECK(open.find("# load_gradient") == open.rfind("# load_gradient"));
  const std::string less = drafted("t,u_V,x_mm,pA_bar");
  for (const char* key :
       {"accumulator_volume", "load_sensing_margin", "main_spool_gain", "seal_friction"}) {
    CAPTURE(key);
    CHECK_FALSE(offers(less, key));
  }
  // The cylinder of a joint has seals, but no load over its travel.
  const std::string joint = drafted("t,u_V,angle_deg,pA_bar,pB_bar,ps_bar");
  CHECK((offers(joint, "leakage_resistance") && offers(joint, "accumulator_volume")));
  CHECK((offers(joint, "seal_friction") && offers(joint, "coulomb_friction")));
  CHECK((offers(joint, "bristle_stiffness") && !offers(joint, "load_curvature")));
  CHECK_FALSE(offers(drafted("t,u_V,angle_deg"), "bristle_stiffness"));
}

TEST_CASE("draft_campaign: an array of Simulink's To File has its time in the first row",
          "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  // Rows are time, reference [mm] and position [mm], stored column by column as MATLAB does.
  std::vector<double> array;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.005 * i;
    const double angle = 12.566370614359172 * t;
    array.insert(array.end(), {t, 5.0 * std::sin(angle), 4.5 * std::sin(angle - 0.3)});
  }
  const auto file = folder.path() / "run_1.mat";
  write_mat(file, format, {mat_array("ans", array, {3, 400})});
  const std::string text = draft_campaign({file}, folder.path()).text;
  CHECK_THAT(text, Contains("time = { column = 'ans(1,:)', unit = 's' }") ||
                       Contains("time = { column = \"ans(1,:)\", unit = \"s\" }"));
  CHECK_THAT(text, Contains("# ans(2,:): -5 to 5") && Contains("# ans(3,:): -4.49") &&
                       Contains("position = { column = "));
  CHECK_THAT(text, !Contains("not used"));

  std::string ready = filled(text);
  const std::size_t from = ready.find("position = { ");
  ready.replace(from, ready.find('\n', from) - from,
                "position = { column = \"ans(3,:)\", unit = \"mm\" }\n"
                "reference = { column = \"ans(2,:)\", unit = \"mm\" }");
  const std::size_t wave = ready.find("waveform = \"FILL IN\"");
  REQUIRE(wave != std::string::npos);
  ready.replace(wave, ready.find('\n', wave) - wave,
                "waveform = \"sine\"\nfrequency = \"2 Hz\"\namplitude = \"5 mm\"");
  const Campaign campaign = load_campaign(folder.write("campaign.toml", ready));
  const Record record = load_record(campaign, campaign.conditions.at(0));
  REQUIRE(record.time_s.size() == 400);
  CHECK_THAT(record.time_s[7], Catch::WithinAbs(0.035, 1e-12));
  CHECK_THAT(record.channels.at(Channel::position).mean[7],
             Catch::WithinAbs(1e-3 * array[7 * 3 + 2], 1e-12));
}

TEST_CASE("draft_campaign: a matrix without a time in its first row is no To File array",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "run.mat";
  write_mat(file, MatFormat::v6, {mat_array<double>("ans", {0, 1, 1, 2, 1, 3, 2, 4}, {2, 4})});
  CHECK_THROWS_WITH(draft_campaign({file}, folder.path()),
                    Contains("no column looks like a time") && Contains("ans(1,:), ans(2,:)"));
  // If the file has only what MATLAB alone can read, the message says what to do.
  const auto text = folder.path() / "text.mat";
  write_mat(text, MatFormat::v6, {mat_text("note", "run 3")});
  CHECK_THROWS_WITH(draft_campaign({text}, folder.path()),
                    Contains("no vector or matrix of numbers") && Contains("ts.Time"));
}

TEST_CASE("draft_campaign: a matrix of HDF5 has its time in the first column", "[datasets]") {
  const TemporaryFolder folder;
  std::vector<double> matrix;
  for (int i = 0; i < 200; ++i)
    matrix.insert(matrix.end(), {10.0 * i, std::sin(0.1 * i), 2.0 * std::sin(0.1 * i - 0.3)});
  const auto path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/log/data", matrix, {200, 3});
    file.texts("/log/data", "units", {"ms", "mm", "mm"});
  }
  const std::string text = draft_campaign({path}, folder.path()).text;
  CHECK_THAT(text, Contains("time = { column = \"/log/data(:,1)\", unit = \"ms\" }"));
  CHECK_THAT(text, Contains("# A matrix with a time in its first column") &&
                       Contains("# /log/data(:,2): -0.99") && Contains("one of these columns"));
}
