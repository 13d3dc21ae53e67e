#include "bench/problems.hpp"

#include <fmt/format.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <stdexcept>

namespace rigcal::bench {
namespace {

struct FreeParameter {
  const char* key;
  double start;  ///< multiple of the true value
  datasets::Scope scope = datasets::Scope::rig;
};

void add_parameters(const model::ParameterValues& truth, const std::vector<FreeParameter>& free,
                    datasets::Campaign& campaign) {
  const auto table = model::parameter_table(truth.plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!truth.given[i]) continue;
    datasets::ParameterSetting setting;
    setting.index = static_cast<int>(i);
    setting.value = truth.value[i];
    for (const FreeParameter& each : free) {
      if (table[i].key != each.key) continue;
      setting.fit = true;
      setting.lower = truth.value[i] / 5.0;
      setting.upper = truth.value[i] * 5.0;
      setting.value = truth.value[i] * each.start;
      setting.scope = each.scope;
    }
    campaign.parameters.push_back(setting);
  }
  datasets::ChannelSetting position;
  position.channel = datasets::Channel::position;
  position.column = "x_m";
  campaign.channels[datasets::Channel::position] = position;
}

void add_condition(const Reference& reference, const std::string& level,
                   const model::ParameterValues& truth, Problem& problem) {
  datasets::Condition condition;
  condition.id = fmt::format("{}_{}_{}", reference.waveform, reference.frequency_hz, level);
  condition.waveform =
      reference.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
  condition.frequency_hz = reference.frequency_hz;
  condition.amplitude = reference.amplitude_m;
  if (!level.empty()) condition.leak_level = level;
  problem.campaign.conditions.push_back(condition);
  datasets::Record record;
  record.condition = condition.id;
  record.time_s = sample_times(reference);
  record.repeats = 5;
  problem.records.push_back(record);
  problem.truth.push_back(truth);
}

/// Returns the values that the rigs of both problems have in common.
model::ParameterValues shaker_truth() {
  auto values = model::ParameterValues::defaults(model::PlantKind::load_pressure);
  values.set("mass", 85.0);
  values.set("damping", 1000.0);
  values.set("piston_area", 1.62e-3);
  values.set("total_volume", 1.62e-3 * 0.1524);
  values.set("supply_pressure", 6.2e6);
  values.set("density", 847.0);
  values.set("bulk_modulus", 689e6);
  values.set("discharge_coefficient", 0.6);
  values.set("area_gradient", 20.75e-3);
  values.set("valve_gain", 4.06e-5);
  values.set("leakage_coefficient", 0.35);
  values.set("output_limit", 10.0);
  return values;
}

}  // namespace

model::ParameterValues paper_rig_truth() {
  auto values = shaker_truth();
  values.set("stiffness", 0.0);
  values.set("leakage_area", 4.456e-6);
  values.set("leakage_smoothing", 100.0);
  values.set("kp", 78.74);
  values.set("kd", 0.394);
  values.set("derivative_filter", 100.0);
  return values;
}

model::ParameterValues six_signal_truth() {
  auto values = shaker_truth();
  values.set("stiffness", 75e3);
  values.set("leakage_area", 5e-7);
  values.set("leakage_smoothing", 1e4);
  values.set("kp", 400.0);
  return values;
}

std::vector<double> sample_times(const Reference& reference) {
  std::vector<double> times(static_cast<std::size_t>(reference.duration_s * 1000.0 + 1.5));
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = static_cast<double>(k) / 1000.0;
  return times;
}

model::SimulationInputs inputs(const Reference& reference) {
  model::SimulationInputs inputs;
  inputs.drive = reference.waveform == "sine"
                     ? model::Signal::sine(reference.amplitude_m, reference.frequency_hz)
                     : model::Signal::square(reference.amplitude_m, reference.frequency_hz);
  return inputs;
}

Problem six_signal_problem(unsigned seed) {
  Problem problem;
  problem.campaign.name = "six signals";
  const auto truth = six_signal_truth();
  add_parameters(
      truth,
      {{"mass", 0.6}, {"bulk_modulus", 1.5}, {"valve_gain", 0.7}, {"leakage_coefficient", 2.0}},
      problem.campaign);
  for (const Reference& reference : kSixSignals) add_condition(reference, "", truth, problem);
  draw_noise(problem, seed);
  return problem;
}

Problem stiff_problem(unsigned seed) {
  Problem problem;
  problem.campaign.name = "paper's rig, four leaks";
  auto truth = paper_rig_truth();
  add_parameters(truth,
                 {{"mass", 0.6},
                  {"bulk_modulus", 1.5},
                  {"valve_gain", 0.7},
                  {"leakage_coefficient", 1.0, datasets::Scope::leak_level}},
                 problem.campaign);
  for (datasets::ParameterSetting& setting : problem.campaign.parameters) {
    if (setting.scope != datasets::Scope::leak_level) continue;
    setting.lower = 1e-4;
    setting.upper = 10.0;
  }
  for (const double coefficient : kPaperLeaks) {
    truth.set("leakage_coefficient", coefficient);
    for (const Reference& reference : kPaperSignals)
      add_condition(reference, fmt::format("{}", coefficient), truth, problem);
  }
  draw_noise(problem, seed);
  return problem;
}

void draw_noise(Problem& problem, unsigned seed) {
  boost::random::mt19937_64 engine(seed);
  boost::random::normal_distribution<double> noise(0.0, kNoiseSd);
  const std::vector<model::Output> outputs{model::Output::position};
  model::SimulationOptions options;
  options.tolerance = 1e-9;
  const std::vector<Reference>& references =
      problem.records.size() == kSixSignals.size() ? kSixSignals : kPaperSignals;
  for (std::size_t i = 0; i < problem.records.size(); ++i) {
    datasets::Record& record = problem.records[i];
    const auto run =
        model::simulate({}, problem.truth[i], {}, inputs(references[i % references.size()]),
                        record.time_s, outputs, options);
    if (!run.ok()) throw std::runtime_error(run.reason);
    datasets::Series series;
    for (Eigen::Index k = 0; k < run.outputs.rows(); ++k)
      series.mean.push_back(run.outputs(k, 0) + noise(engine));
    series.count.assign(series.mean.size(), 5);
    series.repeats = 5;
    series.pooled_sd = 0.05e-3;
    series.sd_of_mean = kNoiseSd;
    record.channels[datasets::Channel::position] = series;
  }
}

}  // namespace rigcal::bench
