// Measures how often 95 % intervals include the truth. Generates many short synthetic campaigns of
// the paper's rig, then aligns, averages and fits them with the code of `rigcal synthesize` and
// `rigcal fit`, from start values that are 10 % off. Prints the table in docs/uncertainty.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/problems.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "common/significant.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/synthetic/noise.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kNoiseOfOne = 0.05e-3;  // standard deviation of one repeat [m]
constexpr double kOffTruth = 1.1;
constexpr double kRateHz = 1000.0;
constexpr double kTwelveBits = 0.1524 / 4096.0;  // stroke divided by the number of codes [m]

/// Disturbances in the repeats.
struct Scenario {
  std::string name;
  double white_m = kNoiseOfOne;
  double ar1_m = 0.0;  ///< standard deviation; correlation 0.95 at 1 ms
  double drift_m = 0.0;
  double hum_m = 0.0;  ///< amplitude at 50 Hz, with a random phase in each repeat
  double quantisation_m = 0.0;
  double jitter_s = 0.0;
  double supply = 0.0;      ///< relative standard deviation of the supply between repeats
  double oil = 0.0;         ///< relative standard deviation of the bulk modulus between repeats
  double friction_n = 0.0;  ///< Coulomb friction that the fitted model lacks
  bool leaks = true;        ///< if false, the leakage coefficient is at its bound
  int repeats = 5;
};

std::vector<Scenario> scenarios() {
  std::vector<Scenario> all;
  const auto add = [&](const std::string& name, const auto& change) {
    Scenario& each = all.emplace_back();
    each.name = name;
    change(each);
  };
  add("white noise of 0.05 mm", [](Scenario&) {});
  add("two repeats of it", [](Scenario& s) { s.repeats = 2; });
  add("AR(1) noise of 0.02 mm", [](Scenario& s) { s.white_m = 0.0, s.ar1_m = 0.02e-3; });
  add("AR(1) noise of 0.05 mm", [](Scenario& s) { s.white_m = 0.0, s.ar1_m = kNoiseOfOne; });
  add("drift of 0.05 mm", [](Scenario& s) { s.drift_m = kNoiseOfOne; });
  add("hum of 50 Hz, 0.1 mm", [](Scenario& s) { s.hum_m = 2.0 * kNoiseOfOne; });
  add("12 bits, noise of 0.05 mm", [](Scenario& s) { s.quantisation_m = kTwelveBits; });
  add("12 bits, noise of 0.01 mm",
      [](Scenario& s) { s.white_m = 0.01e-3, s.quantisation_m = kTwelveBits; });
  add("trigger jitter of 0.1 ms", [](Scenario& s) { s.jitter_s = 0.1e-3; });
  add("trigger jitter of 1 ms", [](Scenario& s) { s.jitter_s = 1e-3; });
  for (const int percent : {1, 2, 3}) {
    add(fmt::format("supply pressure differs by {} %", percent),
        [&](Scenario& s) { s.supply = percent / 100.0; });
  }
  for (const int percent : {3, 10}) {
    add(fmt::format("bulk modulus differs by {} %", percent),
        [&](Scenario& s) { s.oil = percent / 100.0; });
  }
  add("no leak, so that its bound is active", [](Scenario& s) { s.leaks = false; });
  add("unmodelled friction of 100 N", [](Scenario& s) { s.friction_n = 100.0; });
  return all;
}

const std::vector<Reference> kSignals{
    {"square", 1.0, 0.01, 1.0}, {"square", 5.0, 0.005, 0.4}, {"sine", 5.0, 0.03, 0.5}};
const std::vector<std::string> kFree{"mass", "damping", "bulk_modulus", "valve_gain",
                                     "leakage_coefficient"};

int index_of(const std::string& key) {
  return model::parameter_index(model::PlantKind::load_pressure, key);
}

/// Returns the campaign as its user would write it. The truth is in [synthetic].
datasets::Campaign make_campaign(const Scenario& scenario) {
  const model::ParameterValues truth = six_signal_truth();
  const auto table = model::parameter_table(truth.plant);
  datasets::Campaign campaign;
  campaign.synthetic_settings.emplace();
  datasets::SyntheticSettings& synthetic = *campaign.synthetic_settings;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!truth.given[i]) continue;
    datasets::ParameterSetting setting;
    setting.index = static_cast<int>(i);
    setting.value = truth.value[i];
    setting.fit = std::find(kFree.begin(), kFree.end(), table[i].key) != kFree.end();
    if (setting.fit) {
      const bool absent = !scenario.leaks && table[i].key == "leakage_coefficient";
      synthetic.parameters.emplace_back(setting.index, absent ? 0.0 : truth.value[i]);
      setting.lower = absent ? 0.0 : truth.value[i] / 5.0;
      setting.upper = truth.value[i] * 5.0;
      setting.value = truth.value[i] * kOffTruth;
    }
    campaign.parameters.push_back(setting);
  }
  synthetic.repeats = scenario.repeats;
  synthetic.sample_rate_hz = kRateHz;
  synthetic.noise_sd[Channel::position] = scenario.white_m;
  synthetic.ar1_sd[Channel::position] = scenario.ar1_m;
  synthetic.ar1_coefficient = 0.95;
  synthetic.drift[Channel::position] = scenario.drift_m;
  synthetic.quantisation[Channel::position] = scenario.quantisation_m;
  synthetic.trigger_jitter_s = scenario.jitter_s;
  if (scenario.supply > 0.0) synthetic.variation[index_of("supply_pressure")] = scenario.supply;
  if (scenario.oil > 0.0) synthetic.variation[index_of("bulk_modulus")] = scenario.oil;
  if (scenario.friction_n > 0.0)
    synthetic.parameters.emplace_back(index_of("coulomb_friction"), scenario.friction_n);
  datasets::ChannelSetting position;
  position.channel = Channel::position;
  campaign.channels[position.channel] = position;
  for (const Reference& signal : kSignals) {
    datasets::Condition condition;
    condition.id = fmt::format("{}_{}Hz", signal.waveform, signal.frequency_hz);
    condition.waveform =
        signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
    condition.frequency_hz = signal.frequency_hz;
    condition.amplitude = signal.amplitude_m;
    condition.duration_s = signal.duration_s;
    campaign.conditions.push_back(condition);
  }
  return campaign;
}

void add_hum(std::vector<datasets::SyntheticRepeat>& repeats, const std::string& condition,
             double amplitude_m, std::uint64_t seed) {
  for (datasets::SyntheticRepeat& repeat : repeats) {
    auto stream = datasets::random_stream(seed, {condition, repeat.record.source, "hum"});
    const double phase = datasets::uniform(stream, 0.0, 2.0 * std::numbers::pi);
    std::vector<double>& x = repeat.record.values.at(Channel::position);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] +=
          amplitude_m * std::sin(2.0 * std::numbers::pi * 50.0 * repeat.record.time_s[i] + phase);
    }
  }
}

/// Generates, aligns and averages repeats for all conditions.
std::vector<datasets::Record> make_records(const datasets::Campaign& campaign,
                                           const Scenario& scenario, std::uint64_t seed) {
  const datasets::Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : truth.conditions) {
    auto made = datasets::synthetic_repeats(truth, condition, nullptr, seed);
    if (scenario.hum_m > 0.0) add_hum(made, condition.id, scenario.hum_m, seed);
    std::vector<datasets::Repeat> repeats;
    for (datasets::SyntheticRepeat& each : made) repeats.push_back(std::move(each.record));
    records.push_back(datasets::average_of(campaign, condition, repeats, true));
  }
  return records;
}

const calib::FittedParameter& parameter(const calib::Fit& fit, const std::string& key) {
  const int index = index_of(key);
  for (const calib::FittedParameter& each : fit.parameters) {
    if (each.index == index) return each;
  }
  throw std::runtime_error("no parameter " + key);
}

/// Returns the values to which the estimates would converge with ever more records: those of the
/// rig or, if the model lacks a term, those fitted to a record without noise.
std::vector<double> true_values(const Scenario& scenario) {
  std::vector<double> truth;
  for (const std::string& key : kFree)
    truth.push_back(six_signal_truth().value[static_cast<std::size_t>(index_of(key))]);
  if (!scenario.leaks) truth.back() = 0.0;
  if (scenario.friction_n == 0.0) return truth;
  Scenario silent;
  silent.friction_n = scenario.friction_n;
  silent.white_m = 0.0;
  silent.repeats = 1;
  datasets::Campaign campaign = make_campaign(silent);
  campaign.channels[Channel::position].sd = kNoiseOfOne;
  const calib::Fit fit = calib::fit(campaign, make_records(campaign, silent, 1), {});
  for (std::size_t j = 0; j < kFree.size(); ++j) truth[j] = parameter(fit, kFree[j]).value;
  return truth;
}

struct Outcome {
  std::vector<bool> holds, plain;
  std::vector<double> half_width;  ///< relative to the true value; NaN if that is 0
  bool warned = false;
};

Outcome outcome_of(const calib::Fit& fit, const std::vector<double>& truth) {
  if (fit.status != calib::FitStatus::converged) throw std::runtime_error(fit.message);
  const double quantile = metrics::student_t_quantile(
      0.975, static_cast<double>(fit.residual_count - static_cast<long>(kFree.size())));
  Outcome result;
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    const calib::FittedParameter& found = parameter(fit, kFree[j]);
    const auto interval = found.ci95.value();
    result.holds.push_back(interval.low <= truth[j] && truth[j] <= interval.high);
    result.plain.push_back(std::abs(found.value - truth[j]) <=
                           quantile * found.standard_error.value());
    const double half = (interval.high - interval.low) / 2.0;
    result.half_width.push_back(truth[j] == 0.0 ? std::nan("") : half / truth[j]);
  }
  result.warned = fit.lack_of_fit->misfit.value_or(false) ||
                  (fit.between_repeats && fit.between_repeats->differ);
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    const auto expected =
        truth[j] == 0.0 ? calib::Identifiability::bounded : calib::Identifiability::identified;
    result.warned = result.warned || parameter(fit, kFree[j]).identifiability != expected;
  }
  return result;
}

/// Formats the percentages for the outcomes that count: "95.1 94.8 ...", or "-" if there are none.
std::string shares(const std::vector<Outcome>& outcomes, std::vector<bool> Outcome::*holds,
                   bool only_silent) {
  std::vector<std::string> words;
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    long count = 0;
    long held = 0;
    for (const Outcome& each : outcomes) {
      if (only_silent && each.warned) continue;
      ++count;
      held += (each.*holds)[j] ? 1 : 0;
    }
    if (count == 0) return "-";
    words.push_back(
        fmt::format("{:.1f}", 100.0 * static_cast<double>(held) / static_cast<double>(count)));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string median_half_widths(std::vector<Outcome> outcomes) {
  std::vector<std::string> words;
  const auto middle = static_cast<std::ptrdiff_t>(outcomes.size() / 2);
  for (std::size_t j = 0; j < kFree.size(); ++j) {
    std::nth_element(
        outcomes.begin(), outcomes.begin() + middle, outcomes.end(),
        [j](const Outcome& a, const Outcome& b) { return a.half_width[j] < b.half_width[j]; });
    const double percent = 100.0 * outcomes[static_cast<std::size_t>(middle)].half_width[j];
    words.push_back(std::isnan(percent) ? "-" : significant(percent, 2));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

void study(const Scenario& scenario, std::size_t campaigns, int threads) {
  const datasets::Campaign campaign = make_campaign(scenario);
  const std::vector<double> truth = true_values(scenario);
  std::vector<Outcome> outcomes(campaigns);
  parallel_for(campaigns, threads, [&](std::size_t i) {
    const auto records = make_records(campaign, scenario, i + 1);
    outcomes[i] = outcome_of(calib::fit(campaign, records, {}), truth);
    for (const datasets::Record& record : records)
      outcomes[i].warned = outcomes[i].warned || !record.warnings.empty();
  });
  const auto warned = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const Outcome& each) { return each.warned; });
  std::cout << fmt::format("| {} | {} | {:.1f} | {} | {} | {} |\n", scenario.name,
                           shares(outcomes, &Outcome::holds, false),
                           100.0 * static_cast<double>(warned) / static_cast<double>(campaigns),
                           shares(outcomes, &Outcome::holds, true),
                           shares(outcomes, &Outcome::plain, false), median_half_widths(outcomes))
            << std::flush;
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  if (campaigns < 1 || threads < 1 || argc > 4) {
    std::cerr << "usage: rigcal_coverage_study [campaigns] [threads] [part of a scenario's name]\n";
    return 2;
  }
  std::cout << fmt::format(
      "| {} campaigns each | includes the truth, % (`{}`) | warned, % | of those not warned, % | "
      "plain interval, % | median half width, % of the truth |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      campaigns, fmt::join(rigcal::bench::kFree, "`, `"));
  for (const auto& scenario : rigcal::bench::scenarios()) {
    if (scenario.name.find(only) == std::string::npos) continue;
    rigcal::bench::study(scenario, static_cast<std::size_t>(campaigns), threads);
  }
  return 0;
}
