#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem/problem.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "datasets/synthetic/model_output.hpp"
#include "tests/support/paper_rig.hpp"

namespace rigcal::calib {

/// Returns a known value for a campaign.
inline datasets::ParameterSetting known(int index, double value) {
  datasets::ParameterSetting setting;
  setting.index = index;
  setting.value = value;
  return setting;
}

/// A rig with known parameters: the paper's rig with a servo loop that settles within a second. The
/// start values in the campaign differ from the true ones. The records are simulated with the true
/// values, with noise added.
struct Twin {
  datasets::Campaign campaign;
  datasets::Campaign truth;
  std::map<std::string, double> level_leakage;  ///< true leakage coefficient of each leak level
  double noise_sd_m = 5e-5;
  double tolerance = 1e-9;  ///< for the simulations that make the records
  std::map<std::string, std::pair<int, double>> offsets;  ///< condition -> parameter, true value

  Twin() {
    campaign.file = "twin.toml";
    campaign.rig = {model::PlantKind::load_pressure, model::ControllerKind::pid,
                    model::InitialState::rest};
    for (const auto& [key, value] : test::kPaperRig)
      campaign.parameters.push_back(known(index(key), value));
    setting("stiffness").value = 2e4;
    setting("kp").value = 400.0;
    add_channel(datasets::Channel::position);
    truth = campaign;
  }

  static int index(std::string_view key) {
    return model::parameter_index(model::PlantKind::load_pressure, key);
  }

  void add_channel(datasets::Channel channel,
                   datasets::ChannelRole role = datasets::ChannelRole::output) {
    datasets::ChannelSetting setting;
    setting.channel = channel;
    setting.role = role;
    campaign.channels[channel] = setting;
  }

  datasets::ParameterSetting& setting(std::string_view key) {
    for (auto& each : campaign.parameters) {
      if (each.index == index(key)) return each;
    }
    datasets::ParameterSetting added;
    added.index = index(key);
    campaign.parameters.push_back(added);
    return campaign.parameters.back();
  }

  datasets::ParameterSetting& free(std::string_view key, double start, double lower, double upper,
                                   datasets::Scope scope = datasets::Scope::rig) {
    datasets::ParameterSetting& each = setting(key);
    each.value = start;
    each.lower = lower;
    each.upper = upper;
    each.fit = true;
    each.scope = scope;
    return each;
  }

  datasets::Condition& add(const std::string& id, datasets::Waveform waveform, double frequency_hz,
                           double amplitude, const std::string& level = {},
                           datasets::Use use = datasets::Use::fit) {
    datasets::Condition condition;
    condition.id = id;
    condition.waveform = waveform;
    condition.frequency_hz = frequency_hz;
    condition.amplitude = amplitude;
    if (!level.empty()) condition.leak_level = level;
    condition.use = use;
    campaign.conditions.push_back(condition);
    return campaign.conditions.back();
  }

  model::ParameterValues true_values(const datasets::Condition& condition) const {
    auto values = datasets::values_in(truth, condition);
    if (condition.leak_level) {
      const auto level = level_leakage.find(*condition.leak_level);
      if (level != level_leakage.end()) values.set("leakage_coefficient", level->second);
    }
    const auto offset = offsets.find(condition.id);
    if (offset != offsets.end()) values.set(offset->second.first, offset->second.second);
    return values;
  }

  /// Simulates records of all conditions, each with `samples` samples at `rate_hz`. The seed
  /// determines the noise.
  std::vector<datasets::Record> records(int samples, double rate_hz, unsigned seed,
                                        model::InitialState initial = model::InitialState::rest,
                                        bool tell_sd = true) const {
    std::vector<datasets::Record> result;
    boost::random::mt19937_64 random(seed);
    boost::random::normal_distribution<double> normal;
    for (const datasets::Condition& condition : campaign.conditions) {
      datasets::Record record;
      record.condition = condition.id;
      for (int i = 0; i < samples; ++i) record.time_s.push_back(i / rate_hz);
      const auto values = true_values(condition);
      std::vector<model::Output> outputs;
      for (const auto& [channel, setting] : campaign.channels)
        outputs.push_back(datasets::model_output(channel).value());
      model::SimulationOptions options;
      options.tolerance = tolerance;
      model::Rig rig = campaign.rig;
      rig.initial = initial;
      const auto run = model::simulate(rig, values, {},
                                       datasets::inputs_of(campaign, condition, values, nullptr),
                                       record.time_s, outputs, options);
      if (!run.ok()) throw std::runtime_error("twin: " + run.reason);
      Eigen::Index column = 0;
      for (const auto& [channel, setting] : campaign.channels) {
        datasets::Series series;
        const double sd = channel == datasets::Channel::position ? noise_sd_m : 2e4;
        for (int i = 0; i < samples; ++i) {
          const double noise = noise_sd_m > 0.0 ? sd * normal(random) : 0.0;
          series.mean.push_back(run.outputs(i, column) + noise);
        }
        if (tell_sd) series.sd_of_mean = sd > 0.0 ? sd : 5e-5;
        record.channels[channel] = series;
        ++column;
      }
      result.push_back(record);
    }
    return result;
  }
};

/// Returns the parameter of a fit with this key and level; throws if there is none.
inline const FittedParameter& parameter(const Fit& fit, std::string_view key,
                                        const std::string& level = {}) {
  for (const FittedParameter& each : fit.parameters) {
    if (each.index == Twin::index(key) && each.level.value_or("") == level) return each;
  }
  throw std::runtime_error("no parameter " + std::string(key) + " " + level);
}

/// One square wave with mass and valve gain unknown.
inline Twin one_square() {
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  twin.free("valve_gain", 0.04e-3, 0.01e-3, 0.2e-3);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  return twin;
}

/// Returns the problem with all conditions of a twin.
inline Problem problem_of(const Twin& twin, const std::vector<datasets::Record>& records) {
  std::vector<const datasets::Condition*> conditions;
  for (const auto& condition : twin.campaign.conditions) conditions.push_back(&condition);
  return make_problem(twin.campaign, records, conditions, false, nullptr);
}

}  // namespace rigcal::calib
