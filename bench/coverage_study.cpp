// How often 95 % intervals hold the truth: many short synthetic campaigns of the paper's rig, five
// repeats each, fitted from 10 % off. Prints the table of docs/uncertainty.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/problems.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "datasets/noise.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::bench {
namespace {

constexpr int kRepeats = 5;
constexpr double kSdOfOne = 0.05e-3;  // [m]
constexpr double kOffTruth = 1.1;
constexpr double kRateHz = 1000.0;

struct Scenario {
  std::string name;
  double ar1 = 0.0;         ///< correlation of the noise from sample to sample, 1 ms
  double friction_n = 0.0;  ///< Coulomb friction that the fitted model does not have
};
const std::vector<Scenario> kScenarios{{"white noise", 0.0, 0.0},
                                       {"AR(1) noise, 0.95 at 1 ms", 0.95, 0.0},
                                       {"white noise, unmodelled friction of 100 N", 0.0, 100.0}};

const std::vector<Reference> kSignals{
    {"square", 1.0, 0.01, 1.0}, {"square", 5.0, 0.005, 0.4}, {"sine", 2.0, 0.01, 0.5}};
const std::vector<std::string> kFree{"mass", "damping", "valve_gain", "leakage_coefficient"};

datasets::Campaign make_campaign() {
  const model::ParameterValues truth = six_signal_truth();
  const auto table = model::parameter_table(truth.plant);
  datasets::Campaign campaign;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!truth.given[i]) continue;
    datasets::ParameterSetting setting;
    setting.index = static_cast<int>(i);
    setting.value = truth.value[i];
    setting.fit = std::find(kFree.begin(), kFree.end(), table[i].key) != kFree.end();
    if (setting.fit) {
      setting.lower = truth.value[i] / 5.0;
      setting.upper = truth.value[i] * 5.0;
      setting.value = truth.value[i] * kOffTruth;
    }
    campaign.parameters.push_back(setting);
  }
  datasets::ChannelSetting position;
  position.channel = datasets::Channel::position;
  campaign.channels[position.channel] = position;
  for (const Reference& signal : kSignals) {
    datasets::Condition condition;
    condition.id = fmt::format("{}_{}Hz", signal.waveform, signal.frequency_hz);
    condition.waveform =
        signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
    condition.frequency_hz = signal.frequency_hz;
    condition.amplitude = signal.amplitude_m;
    campaign.conditions.push_back(condition);
  }
  return campaign;
}

/// Records without noise; their standard deviation is the one that the noisy ones would have.
std::vector<datasets::Record> silent_records(const datasets::Campaign& campaign,
                                             double friction_n) {
  model::ParameterValues values = six_signal_truth();
  if (friction_n > 0.0) values.set("coulomb_friction", friction_n);
  std::vector<datasets::Record> records;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    datasets::Record record;
    record.condition = campaign.conditions[i].id;
    for (int k = 0; k <= static_cast<int>(kSignals[i].duration_s * kRateHz); ++k)
      record.time_s.push_back(k / kRateHz);
    const std::vector<model::Output> outputs{model::Output::position};
    model::SimulationOptions options;
    options.tolerance = 1e-9;
    const auto run =
        model::simulate({}, values, {}, inputs(kSignals[i]), record.time_s, outputs, options);
    if (!run.ok()) throw std::runtime_error("not simulated: " + run.reason);
    datasets::Series series;
    for (Eigen::Index k = 0; k < run.outputs.rows(); ++k) series.mean.push_back(run.outputs(k, 0));
    series.pooled_sd = kSdOfOne;
    series.sd_of_mean = kSdOfOne / std::sqrt(kRepeats);
    record.channels[datasets::Channel::position] = series;
    records.push_back(record);
  }
  return records;
}

/// Mean and standard deviation of five noisy repeats, as averaging would give them.
void add_noise(datasets::Record& record, double ar1, std::uint64_t seed) {
  datasets::Series& series = record.channels.at(datasets::Channel::position);
  const std::size_t samples = series.mean.size();
  std::vector<double> sum(samples, 0.0);
  std::vector<double> squares(samples, 0.0);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    auto stream = datasets::random_stream(seed, {record.condition, fmt::format("{}", repeat)});
    const auto noise = datasets::ar1_noise(stream, samples, kSdOfOne, ar1);
    for (std::size_t t = 0; t < samples; ++t) {
      sum[t] += noise[t];
      squares[t] += noise[t] * noise[t];
    }
  }
  double total = 0.0;
  for (std::size_t t = 0; t < samples; ++t) {
    const double mean = sum[t] / kRepeats;
    const double variance = (squares[t] - kRepeats * mean * mean) / (kRepeats - 1);
    series.mean[t] += mean;
    series.sd.push_back(std::sqrt(std::max(0.0, variance)));
    total += variance;
  }
  series.count.assign(samples, kRepeats);
  series.repeats = kRepeats;
  series.pooled_sd = std::sqrt(total / static_cast<double>(samples));
  series.sd_of_mean = series.pooled_sd / std::sqrt(kRepeats);
  record.repeats = kRepeats;
}

const calib::FittedParameter& parameter(const calib::Fit& fit, const std::string& key) {
  const int index = model::parameter_index(model::PlantKind::load_pressure, key);
  for (const calib::FittedParameter& each : fit.parameters) {
    if (each.index == index) return each;
  }
  throw std::runtime_error("no parameter " + key);
}

struct Outcome {
  std::vector<bool> robust, plain;
  bool misfit = false;
};

Outcome outcome_of(const calib::Fit& fit, const std::vector<double>& truth) {
  if (fit.status != calib::FitStatus::converged) throw std::runtime_error(fit.message);
  const double quantile = metrics::student_t_quantile(
      0.975, static_cast<double>(fit.residual_count - static_cast<long>(kFree.size())));
  Outcome result;
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    const calib::FittedParameter& found = parameter(fit, kFree[j]);
    const auto interval = found.ci95.value();
    result.robust.push_back(interval.first <= truth[j] && truth[j] <= interval.second);
    result.plain.push_back(std::abs(found.value - truth[j]) <=
                           quantile * found.standard_error.value());
  }
  result.misfit = fit.misfit.value_or(false);
  return result;
}

void study(const Scenario& scenario, std::size_t campaigns, int threads) {
  const datasets::Campaign campaign = make_campaign();
  const auto silent = silent_records(campaign, scenario.friction_n);
  std::vector<double> truth;
  const calib::Fit pseudo_true = calib::fit(campaign, silent, {});
  for (const std::string& key : kFree) {
    const int index = model::parameter_index(model::PlantKind::load_pressure, key);
    truth.push_back(scenario.friction_n > 0.0
                        ? parameter(pseudo_true, key).value
                        : six_signal_truth().value[static_cast<std::size_t>(index)]);
  }
  std::vector<Outcome> outcomes(campaigns);
  parallel_for(campaigns, threads, [&](std::size_t i) {
    auto records = silent;
    for (datasets::Record& record : records) add_noise(record, scenario.ar1, i + 1);
    outcomes[i] = outcome_of(calib::fit(campaign, records, {}), truth);
  });
  const auto percent = [&](auto holds) {
    long count = 0;
    for (const Outcome& each : outcomes) count += holds(each) ? 1 : 0;
    return fmt::format("{:.1f}",
                       100.0 * static_cast<double>(count) / static_cast<double>(campaigns));
  };
  std::vector<std::string> robust;
  std::vector<std::string> plain;
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    robust.push_back(percent([j](const Outcome& each) { return each.robust[j]; }));
    plain.push_back(percent([j](const Outcome& each) { return each.plain[j]; }));
  }
  std::cout << fmt::format("| {} | {} | {} | {} |\n", scenario.name, fmt::join(robust, " "),
                           fmt::join(plain, " "),
                           percent([](const Outcome& each) { return each.misfit; }))
            << std::flush;
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  if (campaigns < 1 || threads < 1 || argc > 3) {
    std::cerr << "usage: rigcal_coverage_study [campaigns] [threads]\n";
    return 2;
  }
  std::cout << fmt::format(
      "| {} campaigns each | default interval, % ({}) | plain interval, % | misfit flagged, % |\n"
      "| --- | --- | --- | --- |\n",
      campaigns, fmt::join(rigcal::bench::kFree, ", "));
  for (const auto& scenario : rigcal::bench::kScenarios)
    rigcal::bench::study(scenario, static_cast<std::size_t>(campaigns), threads);
  return 0;
}
