#include "calib/consider/catalogue.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "bench/foreign_campaign.hpp"
#include "calib/problem/problem.hpp"
#include "tests/calib/twin.hpp"
#include "tests/datasets/campaign_fixture.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinRel;

/// Readings of a foreign rig in one condition, and the fit problem for them at the true values.
struct ForeignProblem {
  bench::ForeignRig rig;
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;

  explicit ForeignProblem(const bench::Reference& reference) : reference_(reference) {
    campaign = bench::foreign_campaign(rig);
    for (const auto& [key, value] :
         {std::pair{"mass", rig.mass_kg}, std::pair{"damping", rig.damping_n_s_per_m},
          std::pair{"bulk_modulus", rig.bulk_modulus_pa},
          std::pair{"valve_gain", rig.valve_gain_m_per_v},
          std::pair{"leakage_coefficient", rig.leak_coefficient}})
      campaign.parameters.push_back(known(Twin::index(key), value));
    // One unknown, because a problem must have at least one.
    datasets::ParameterSetting& mass =
        *std::find_if(campaign.parameters.begin(), campaign.parameters.end(),
                      [](const auto& each) { return each.index == Twin::index("mass"); });
    mass.fit = true;
    mass.lower = 20.0;
    mass.upper = 500.0;
    datasets::Condition& condition = campaign.conditions.emplace_back();
    condition.id = "one";
    condition.waveform =
        reference.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
    condition.frequency_hz = reference.frequency_hz;
    condition.amplitude = reference.amplitude_m;
    condition.duration_s = reference.duration_s;
    datasets::Record& record = records.emplace_back();
    record.condition = "one";
    datasets::Series series;
    series.mean = bench::foreign_readings(rig, reference);
    series.sd_of_mean = 1.0;
    for (std::size_t k = 0; k < series.mean.size(); ++k)
      record.time_s.push_back(static_cast<double>(k) / 1000.0);
    record.channels[datasets::Channel::position] = series;
  }

  /// Change of the readings due to an effect of the foreign rig.
  Eigen::VectorXd change(void (*apply)(bench::ForeignRig&, double), double size) const {
    bench::ForeignRig with = rig;
    apply(with, size);
    const std::vector<double> there = bench::foreign_readings(with, reference_);
    const std::vector<double>& here = records[0].channels.at(datasets::Channel::position).mean;
    Eigen::VectorXd result(static_cast<Eigen::Index>(here.size()));
    for (std::size_t k = 0; k < here.size(); ++k)
      result(static_cast<Eigen::Index>(k)) = there[k] - here[k];
    return result;
  }

 private:
  bench::Reference reference_;
};

/// An effect, with its counterpart in the foreign rig.
struct CounterpartRow {
  const char* key;
  void (*apply)(bench::ForeignRig&, double size);
  double size;     ///< plausible size on this rig
  double allowed;  ///< largest difference between the two changes, relative to their size
};

const std::vector<CounterpartRow> kCounterparts{
    {"valve_hysteresis", [](bench::ForeignRig& r, double s) { r.valve_play_v = s; }, 0.01, 0.1},
    {"valve_dead_band", [](bench::ForeignRig& r, double s) { r.dead_band_v = s; }, 0.01, 0.02},
    {"coulomb_friction", [](bench::ForeignRig& r, double s) { r.friction_n = s; },
     1e-3 * 1.62e-3 * 6.2e6, 0.02},
    {"stribeck_friction", [](bench::ForeignRig& r, double s) { r.breakaway_n = s; },
     1e-3 * 1.62e-3 * 6.2e6, 0.02},
    {"sample_time", [](bench::ForeignRig& r, double s) { r.controller_tick_s = s; }, 1e-3, 0.02},
    {"supply_sag", [](bench::ForeignRig& r, double s) { r.sag = s; }, 0.01, 0.1},
    {"ki", [](bench::ForeignRig& r, double s) { r.integral_v_per_m_s = s; }, 2.4, 0.02},
    {"valve_time_constant", [](bench::ForeignRig& r, double s) { r.valve_lag_s = s; }, 0.5e-3,
     0.02},
    {"total_volume", [](bench::ForeignRig& r, double s) { r.hose_volume_m3 = s; }, 2.46888e-6,
     0.02},
    {"loop_gain",
     [](bench::ForeignRig& r, double s) {
       r.sensor_in_loop = true;
       r.sensor_gain = s;
     },
     2e-3, 0.02},
    {"trigger", [](bench::ForeignRig& r, double s) { r.delay_s = -s; }, 0.1e-3, 0.02},
    {"valve_underlap", [](bench::ForeignRig& r, double s) { r.underlap_v = s; }, 0.01, 0.1}};

/// Effects of the table above that may be negative.
bool may_be_negative(std::string_view key) { return key == "loop_gain" || key == "trigger"; }

TEST_CASE("catalogue: what an effect does to a record is what another integrator makes of it",
          "[calib]") {
  for (const bench::Reference& reference :
       {bench::Reference{"square", 4.0, 0.02, 0.5}, bench::Reference{"sine", 5.0, 0.02, 0.4}}) {
    const ForeignProblem foreign(reference);
    const Problem problem = make_problem(foreign.campaign, foreign.records,
                                         {&foreign.campaign.conditions.front()}, false, nullptr);
    std::vector<double> z = problem.start();
    const auto effects = effects_of(problem, z);
    const Eigen::MatrixXd rows = effect_rows(problem, 0, z, effects, nullptr);
    for (const CounterpartRow& row : kCounterparts) {
      CAPTURE(reference.waveform, row.key);
      const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& each) {
        return each.about.key == row.key;
      });
      REQUIRE(found != effects.end());
      CHECK_THAT(found->about.size, WithinRel(row.size, 1e-6));
      CHECK(found->about.one_sided != may_be_negative(row.key));
      const Eigen::VectorXd ours = rows.col(found - effects.begin());
      const Eigen::VectorXd theirs = foreign.change(row.apply, row.size);
      CHECK((ours - theirs).norm() < row.allowed * theirs.norm());
      // A refit simulates all effects at once.
      Eigen::VectorXd sizes = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effects.size()));
      const Eigen::VectorXd none =
          outputs_with(problem, 0, z, effects, sizes, Derivatives::none, nullptr).outputs;
      sizes(found - effects.begin()) = 1.0;
      const OutputsWith with =
          outputs_with(problem, 0, z, effects, sizes, Derivatives::of_unknowns, nullptr);
      REQUIRE(with.ok());
      CHECK((with.outputs - none - theirs).norm() < row.allowed * theirs.norm());
      CHECK(with.jacobian.norm() > 0.0);
    }
  }
}

TEST_CASE("catalogue: effects that step at each sample have a budget of their own", "[calib]") {
  const ForeignProblem foreign({"square", 4.0, 0.02, 0.5});
  Problem problem = make_problem(foreign.campaign, foreign.records,
                                 {&foreign.campaign.conditions.front()}, false, nullptr);
  const std::vector<double> z = problem.start();
  const auto effects = effects_of(problem, z);
  problem.conditions.front().max_steps = 20;  // as of a search that began in a steady state
  CHECK(effect_rows(problem, 0, z, effects, nullptr).allFinite());
}

TEST_CASE("catalogue: an offset also moves a start that is taken from its reading", "[calib]") {
  const ForeignProblem foreign({"sine", 5.0, 0.02, 0.4});
  Problem problem = make_problem(foreign.campaign, foreign.records,
                                 {&foreign.campaign.conditions.front()}, false, nullptr);
  const std::vector<double> z = problem.start();
  std::vector<Effect> effects = effects_of(problem, z);
  std::erase_if(effects, [](const Effect& each) { return each.about.key != "position_offset"; });
  REQUIRE(effects.size() == 1);
  const auto change = [&] {
    constexpr std::array kFurther{model::Output::load_pressure};
    return effect_changes(problem, 0, problem.values_at(0, z), problem.conditions[0].fit_times(),
                          effects, nullptr, kFurther);
  };
  const double size = effects.front().about.size;
  const auto at_rest = change();
  CHECK((at_rest[0].array() - size).matrix().norm() < 1e-9 * at_rest[0].norm());
  CHECK(at_rest[1].isZero());
  // A piston that starts from its reading starts lower by the offset, so that its first reading
  // stays as it is. The loop then pulls it up.
  problem.conditions.front().rig.initial = model::InitialState::given;
  const auto given = change();
  CHECK(std::abs(given[0](0)) < 1e-3 * size);
  const double last = given[0](given[0].rows() - 1);
  CHECK(last > 0.5 * size);
  CHECK(last < size);
  CHECK(given[1].norm() > 0.0);
}

TEST_CASE("catalogue: the leak of closed edges is an effect where it is no laminar leak",
          "[calib]") {
  const auto has = [](model::PlantKind plant, const char* key) {
    const auto names = datasets::effect_names(plant);
    return std::any_of(names.begin(), names.end(),
                       [&](const auto& each) { return each.key == key; });
  };
  CHECK_FALSE(has(model::PlantKind::load_pressure, "valve_null_leakage"));
  CHECK(has(model::PlantKind::two_chamber, "valve_null_leakage"));
  CHECK(has(model::PlantKind::linkage, "valve_null_leakage"));
  CHECK(has(model::PlantKind::linkage, "pilot_hysteresis"));
  CHECK_FALSE(has(model::PlantKind::two_chamber, "pilot_hysteresis"));
  // The friction of a joint includes that of its cylinder.
  CHECK(has(model::PlantKind::linkage, "joint_friction"));
  CHECK_FALSE(has(model::PlantKind::linkage, "coulomb_friction"));
  CHECK(has(model::PlantKind::two_chamber, "stribeck_friction"));
}

TEST_CASE("catalogue: gains are those of the loop that the rig has", "[calib]") {
  Twin twin = one_square();
  twin.setting("kp").value = 0.0;
  twin.setting("force_kp").value = 1e-3;
  twin.campaign.rig.feedback = model::Feedback::force;
  twin.campaign.conditions.front().amplitude = 500.0;
  twin.truth = twin.campaign;
  const auto records = twin.records(500, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  std::vector<std::string> gains;
  for (const Effect& each : effects_of(problem, problem.start())) {
    const std::string& key = each.about.key;
    if (key.ends_with("_kp") || key.ends_with("_ki") || key == "kp" || key == "ki")
      gains.push_back(key);
    if (key == "force_kp") CHECK_THAT(each.about.size, WithinRel(5e-6, 1e-12));
  }
  CHECK(gains == std::vector<std::string>{"force_ki", "force_kp"});
  CHECK_FALSE(sensor_channel("force_kp"));
  CHECK(sensor_channel("force_gain") == datasets::Channel::force);
  CHECK(sensor_channel("torque_offset") == datasets::Channel::torque);
  CHECK(sensor_channel("payload_acceleration_lag") == datasets::Channel::payload_acceleration);
}

TEST_CASE("catalogue: three-variable control has the gains of a position loop", "[calib]") {
  Twin twin = one_square();
  twin.setting("velocity_kp").value = 2.0;
  twin.setting("reference_frequency").value = 60.0;
  twin.setting("reference_damping_ratio").value = 0.7;
  twin.campaign.rig.feedback = model::Feedback::three_variable;
  twin.truth = twin.campaign;
  const auto records = twin.records(500, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  std::vector<std::string> gains;
  for (const Effect& each : effects_of(problem, problem.start())) {
    const std::string& key = each.about.key;
    if (key.ends_with("kp") || key.ends_with("ki") || key.ends_with("kd")) gains.push_back(key);
    if (key == "velocity_kp") CHECK_THAT(each.about.size, WithinRel(0.02, 1e-12));
  }
  CHECK(gains == std::vector<std::string>{"ki", "kp", "velocity_kp"});
  std::vector<std::string> names;
  for (const auto& each : datasets::effect_names(model::PlantKind::load_pressure))
    names.push_back(each.key);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
}

TEST_CASE("catalogue: a controller's period is an effect only of a loop that has none", "[calib]") {
  Twin twin = one_square();
  const auto keys = [&] {
    const auto records = twin.records(500, 1000.0, 1);
    const Problem problem = problem_of(twin, records);
    std::vector<std::string> all;
    for (const Effect& each : effects_of(problem, problem.start())) all.push_back(each.about.key);
    return all;
  };
  const auto contains = [](const std::vector<std::string>& all, const char* key) {
    return std::find(all.begin(), all.end(), key) != all.end();
  };
  CHECK(contains(keys(), "sample_time"));
  twin.campaign.parameters.push_back(known(Twin::index("sample_time"), 2e-3));
  twin.truth.parameters.push_back(known(Twin::index("sample_time"), 2e-3));
  CHECK_FALSE(contains(keys(), "sample_time"));
  Twin driven = one_square();
  driven.campaign.rig.controller = model::ControllerKind::none;
  driven.campaign.conditions.front().amplitude = 0.5;
  driven.truth = driven.campaign;
  twin = driven;
  const auto open = keys();
  CHECK_FALSE(contains(open, "sample_time"));
  CHECK(contains(open, "valve_hysteresis"));
}

/// Returns readings that any sensor or drive of a shipped rig may have: a slow sine about a usual
/// value.
std::vector<double> usual_readings(const datasets::Campaign& campaign, datasets::Channel channel,
                                   const std::vector<double>& time_s) {
  const std::string_view unit = datasets::info(channel).unit;
  double middle = 0.0;
  double amplitude = unit == "V" ? 2.0 : unit == "N" || unit == "N m" ? 100.0 : 1e-3;
  if (unit == "Pa") {
    middle = channel == datasets::Channel::supply_pressure ? 2e7 : 1e6;
    amplitude = channel == datasets::Channel::pilot_pressure ? 2e6 : 1e5;
  }
  if (unit == "K") middle = 313.0;
  if (channel == datasets::Channel::angle) {
    for (const char* stop : {"lower_stop", "upper_stop"})
      middle += 0.5 * campaign.setting(model::parameter_index(campaign.rig.plant, stop))->value;
  }
  std::vector<double> readings;
  for (const double t : time_s) readings.push_back(middle + amplitude * std::sin(12.0 * t));
  return readings;
}

/// The fit problem of a campaign with made-up records.
struct MadeProblem {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;

  explicit MadeProblem(datasets::Campaign of) : campaign(std::move(of)) {
    std::erase_if(campaign.conditions,
                  [](const auto& each) { return each.use != datasets::Use::fit; });
    const datasets::Channel drive = datasets::drive_channel(campaign);
    for (datasets::Condition& condition : campaign.conditions) {
      condition.windows.clear();
      datasets::Record& record = records.emplace_back();
      record.condition = condition.id;
      for (int i = 0; i < 300; ++i) record.time_s.push_back(2e-3 * i);
      for (const auto& [channel, setting] : campaign.channels) {
        if (setting.role == datasets::ChannelRole::ignore && channel != drive) continue;
        datasets::Series series;
        series.mean = usual_readings(campaign, channel, record.time_s);
        series.sd_of_mean = 1.0;
        record.channels[channel] = series;
      }
    }
  }

  Problem problem() const {
    std::vector<const datasets::Condition*> conditions;
    for (const auto& each : campaign.conditions) conditions.push_back(&each);
    return make_problem(campaign, records, conditions, false, nullptr);
  }
};

bool is_any_of(std::string_view key, std::initializer_list<std::string_view> keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Whether a rig has what an effect acts on. Written down anew, not taken from the catalogue.
bool rig_has(const datasets::Campaign& campaign, std::string_view key) {
  const model::Rig& rig = campaign.rig;
  const bool closed = rig.controller != model::ControllerKind::none;
  const bool turns = rig.plant == model::PlantKind::linkage;
  for (const model::FeedbackRow& loop : model::kFeedbacks) {
    if (is_any_of(key, {loop.kp, loop.ki, loop.kd})) {
      const model::FeedbackRow& own = model::gain_keys(rig.feedback);
      return closed && is_any_of(key, {own.kp, own.ki, own.kd});
    }
  }
  if (key == "sample_time") return closed;
  if (key == "loop_gain") {
    const bool of_motion =
        turns ? rig.feedback == model::Feedback::angle : rig.feedback == model::Feedback::position;
    return closed && of_motion &&
           std::none_of(
               campaign.conditions.begin(), campaign.conditions.end(),
               [](const auto& each) { return each.waveform == datasets::Waveform::recorded; });
  }
  for (const datasets::ChannelInfo& channel : datasets::channel_table()) {
    if (!key.starts_with(channel.key)) continue;
    if (!is_any_of(key.substr(channel.key.size()),
                   {"_lag", "_gain", "_offset", "_bow", "_wave", "_hysteresis"}))
      continue;
    const auto setting = campaign.channels.find(channel.channel);
    return setting != campaign.channels.end() &&
           setting->second.role == datasets::ChannelRole::output;
  }
  if (key.starts_with("pilot_")) return rig.pilot;
  if (is_any_of(key, {"valve_dead_band", "valve_underlap", "valve_offset", "valve_hysteresis"}))
    return !rig.pilot;
  if (key == "joint_friction") return turns;
  if (is_any_of(key, {"coulomb_friction", "stribeck_friction"})) return !turns;
  if (key == "total_volume") return rig.plant == model::PlantKind::load_pressure;
  if (key.starts_with("dead_volume_")) return rig.plant != model::PlantKind::load_pressure;
  if (key == "supply_sag") {
    const auto supply = campaign.channels.find(datasets::Channel::supply_pressure);
    const bool recorded =
        supply != campaign.channels.end() && supply->second.role == datasets::ChannelRole::input;
    const int pump = model::parameter_index(rig.plant, "pump_flow");
    return !recorded && (pump < 0 || campaign.setting(pump) == nullptr);
  }
  return is_any_of(key, {"valve_time_constant", "transport_delay", "trigger", "laminar_leakage",
                         "valve_null_leakage", "leakage_coefficient"});
}

/// Gives the rig of a campaign another loop, or none, with generated or recorded drives.
datasets::Campaign with_loop(datasets::Campaign campaign, model::ControllerKind controller,
                             model::Feedback feedback, datasets::Waveform waveform) {
  campaign.rig.controller = controller;
  campaign.rig.feedback = feedback;
  if (controller != model::ControllerKind::none) {
    datasets::ParameterSetting gain;
    gain.index = model::parameter_index(campaign.rig.plant, model::gain_keys(feedback).kp);
    gain.value = 1.0;
    std::erase_if(campaign.parameters, [&](const auto& each) { return each.index == gain.index; });
    campaign.parameters.push_back(gain);
  }
  const datasets::Channel drive = datasets::drive_channel(campaign);
  datasets::ChannelSetting& setting = campaign.channels[drive];
  setting.channel = drive;
  setting.role = datasets::ChannelRole::input;
  for (datasets::Condition& each : campaign.conditions) {
    each.waveform = waveform;
    each.frequency_hz = 2.0;
    each.amplitude = 1e-3;
  }
  return campaign;
}

void check_effects_of(const datasets::Campaign& campaign) {
  const MadeProblem made(campaign);
  const Problem problem = made.problem();
  for (const Effect& each : effects_of(problem, problem.start())) {
    CAPTURE(each.about.key);
    CHECK(rig_has(made.campaign, each.about.key));
    const auto* setting = each.index < 0 ? nullptr : campaign.setting(each.index);
    CHECK_FALSE((setting != nullptr && setting->fit));
  }
}

TEST_CASE("catalogue: a rig has what its effects act on", "[calib]") {
  int campaigns = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(RIGCAL_SOURCE_DIR) / "datasets/rigs")) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path().string());
    const datasets::Campaign campaign = datasets::load_campaign(entry.path());
    ++campaigns;
    check_effects_of(campaign);
    for (const auto waveform : {datasets::Waveform::sine, datasets::Waveform::recorded}) {
      CAPTURE(waveform);
      check_effects_of(
          with_loop(campaign, model::ControllerKind::none, model::Feedback::position, waveform));
      if (campaign.rig.pilot) continue;
      for (std::size_t i = 0; i < model::kFeedbackCount; ++i) {
        const auto feedback = static_cast<model::Feedback>(i);
        if (!model::has_loop(campaign.rig.plant, feedback)) continue;
        CAPTURE(model::gain_keys(feedback).name);
        check_effects_of(with_loop(campaign, model::ControllerKind::pid, feedback, waveform));
      }
    }
  }
  CHECK(campaigns >= 20);
}

TEST_CASE("catalogue: each effect of a shipped rig changes a record", "[calib]") {
  for (const char* file : {"uis_shake_table/campaign.toml", "festo_tp511/campaign.toml",
                           "hopsan_leaky_servo/two_chamber_fit.toml",
                           "excavator_dspace/boom_up.toml", "nrc_fatigue_rig/campaign.toml"}) {
    CAPTURE(file);
    MadeProblem made(
        datasets::load_campaign(std::filesystem::path(RIGCAL_SOURCE_DIR) / "datasets/rigs" / file));
    const Problem problem = made.problem();
    const std::vector<double> z = problem.start();
    const auto effects = effects_of(problem, z);
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effects.size()));
    for (std::size_t i = 0; i < problem.conditions.size(); ++i)
      largest = largest.cwiseMax(
          effect_rows(problem, i, z, effects, nullptr).cwiseAbs().colwise().maxCoeff().transpose());
    for (std::size_t e = 0; e < effects.size(); ++e) {
      CAPTURE(effects[e].about.key);
      CHECK(largest(static_cast<Eigen::Index>(e)) > 0.0);
    }
  }
}

}  // namespace
}  // namespace rigcal::calib
