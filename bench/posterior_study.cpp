// Simulation-based calibration of the posterior (Talts et al., arXiv:1804.06788). Draws true values
// from the prior, generates records from them, and ranks each true value among the draws of its
// posterior. The ranks must be uniform. Prints the table in docs/uncertainty.md. With --speed,
// samples the posterior for the six signals of the speed tests instead, and prints CPU time and
// effective draws. With --replay, reads lines of sampler coordinates and answers each with the log
// density, for samplers in other languages (bench/ensemble.py).
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "bench/problems.hpp"
#include "calib/fit.hpp"
#include "calib/posterior/density.hpp"
#include "calib/trust/uncertainty.hpp"
#include "common/parallel.hpp"
#include "datasets/synthetic/model_output.hpp"
#include "datasets/synthetic/noise.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kTwinNoise_m = 0.5e-3;
constexpr double kTwinRateHz = 250.0;
constexpr int kBins = 20;
constexpr int kThinned = 100;  ///< number of posterior draws among which a true value is ranked

double cpu_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Returns a campaign for the paper's rig with two short records and three unknowns, each bounded
/// by half and twice its usual value.
datasets::Campaign make_campaign(int number) {
  const model::ParameterValues usual = six_signal_truth();
  const auto table = model::parameter_table(usual.plant);
  datasets::Campaign campaign;
  campaign.file = fmt::format("campaign_{}", number);
  const std::vector<std::string_view> free{"mass", "valve_gain", "leakage_coefficient"};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!usual.given[i]) continue;
    datasets::ParameterSetting setting;
    setting.index = static_cast<int>(i);
    setting.value = usual.value[i];
    setting.fit = std::find(free.begin(), free.end(), table[i].key) != free.end();
    setting.lower = 0.5 * usual.value[i];
    setting.upper = 2.0 * usual.value[i];
    campaign.parameters.push_back(setting);
  }
  datasets::ChannelSetting position;
  position.channel = Channel::position;
  campaign.channels[position.channel] = position;
  for (const Reference& signal :
       {Reference{"square", 2.0, 0.01, 0.5}, Reference{"sine", 5.0, 0.02, 0.4}}) {
    datasets::Condition condition;
    condition.id = signal.waveform;
    condition.waveform =
        signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
    condition.frequency_hz = signal.frequency_hz;
    condition.amplitude = signal.amplitude_m;
    condition.duration_s = signal.duration_s;
    campaign.conditions.push_back(condition);
  }
  return campaign;
}

std::vector<datasets::Record> records_of(const datasets::Campaign& campaign, std::uint64_t seed,
                                         const std::vector<std::pair<int, double>>& truths) {
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    datasets::Record record;
    record.condition = condition.id;
    const int samples = static_cast<int>(*condition.duration_s * kTwinRateHz);
    for (int i = 0; i < samples; ++i) record.time_s.push_back(i / kTwinRateHz);
    model::ParameterValues values = datasets::values_in(campaign, condition);
    for (const auto& [index, value] : truths) values.set(index, value);
    const std::vector<model::Output> outputs{model::Output::position};
    model::SimulationOptions options;
    options.tolerance = 1e-9;
    const auto run = model::simulate(campaign.rig, values, {},
                                     datasets::inputs_of(campaign, condition, values, nullptr),
                                     record.time_s, outputs, options);
    if (!run.ok()) throw std::runtime_error("posterior study: " + run.reason);
    auto stream = datasets::random_stream(seed, {"noise", condition.id});
    datasets::Series series;
    for (int i = 0; i < samples; ++i)
      series.mean.push_back(run.outputs(i, 0) + datasets::normal(stream, kTwinNoise_m));
    series.sd_of_mean = kTwinNoise_m;
    record.channels[Channel::position] = series;
    records.push_back(std::move(record));
  }
  return records;
}

/// Bins into which the ranks of one campaign's true values fall; empty if the fit did not converge.
struct Ranked {
  std::vector<int> bins;
  std::vector<std::string> names;
  double r_hat = 0.0;
  int diverged = 0;
};

Ranked rank_truths(int number, std::uint64_t seed) {
  const std::uint64_t own = seed * 1'000'003U + static_cast<std::uint64_t>(number);
  const datasets::Campaign campaign = make_campaign(number);
  auto stream = datasets::random_stream(own, {"truth"});
  std::vector<std::pair<int, double>> truths;
  for (const datasets::ParameterSetting& each : campaign.parameters) {
    if (each.fit)
      truths.emplace_back(each.index, datasets::uniform(stream, each.lower, each.upper));
  }
  const auto records = records_of(campaign, own, truths);
  calib::FitOptions options;
  options.consider = false;
  options.starts = 4;
  options.seed = own;
  options.posterior = 400;
  const calib::Fit fit = calib::fit(campaign, records, options);
  if (fit.status != calib::FitStatus::converged || !fit.posterior) return {};
  Ranked result;
  result.names = fit.posterior->names;
  result.r_hat = fit.posterior->r_hat;
  result.diverged = fit.posterior->diverged;
  for (std::size_t j = 0; j < result.names.size(); ++j) {
    const std::vector<double>& values = fit.posterior->values[j];
    const auto truth = std::find_if(truths.begin(), truths.end(), [&](const auto& each) {
      return each.first == fit.parameters[j].index;
    });
    const std::size_t every = values.size() / kThinned;
    int below = 0;
    for (std::size_t k = 0; k < kThinned; ++k) below += values[k * every] < truth->second ? 1 : 0;
    result.bins.push_back(below * kBins / (kThinned + 1));
  }
  return result;
}

int study(int campaigns, int threads, std::uint64_t seed) {
  std::vector<Ranked> all(static_cast<std::size_t>(campaigns));
  parallel_for(all.size(), threads,
               [&](std::size_t i) { all[i] = rank_truths(static_cast<int>(i), seed); });
  std::vector<std::vector<int>> counts;
  std::vector<std::string> names;
  int lost = 0;
  int mixed = 0;
  int diverged = 0;
  for (const Ranked& each : all) {
    if (each.bins.empty()) {
      ++lost;
      continue;
    }
    names = each.names;
    counts.resize(each.bins.size(), std::vector<int>(kBins, 0));
    for (std::size_t j = 0; j < each.bins.size(); ++j)
      ++counts[j][static_cast<std::size_t>(each.bins[j])];
    mixed += each.r_hat <= 1.01 ? 1 : 0;
    diverged += each.diverged > 0 ? 1 : 0;
  }
  fmt::print(
      "{} campaigns, {} whose fit did not converge, {} with R-hat above 1.01, {} with "
      "divergences\n\n",
      campaigns, lost, campaigns - lost - mixed, diverged);
  fmt::print("| parameter | counts of the ranks, {} bins | chi-square | p |\n", kBins);
  fmt::print("| --- | --- | --- | --- |\n");
  bool uniform = true;
  for (std::size_t j = 0; j < counts.size(); ++j) {
    // The 101 ranks cannot be divided equally among the bins.
    std::vector<double> expected(kBins, 0.0);
    for (int rank = 0; rank <= kThinned; ++rank)
      expected[static_cast<std::size_t>(rank * kBins / (kThinned + 1))] +=
          static_cast<double>(campaigns - lost) / (kThinned + 1);
    double chi_squared = 0.0;
    std::string text;
    for (std::size_t b = 0; b < kBins; ++b) {
      chi_squared += (counts[j][b] - expected[b]) * (counts[j][b] - expected[b]) / expected[b];
      text += fmt::format("{}{}", b == 0 ? "" : " ", counts[j][b]);
    }
    const double p = metrics::chi_squared_exceedance(chi_squared, kBins - 1.0);
    uniform = uniform && p > 0.01;
    fmt::print("| `{}` | {} | {:.1f} | {:.2g} |\n", names[j], text, chi_squared, p);
  }
  return uniform ? 0 : 1;
}

/// Prints what the posterior of the six signals costs.
///
/// @param consider  whether the sizes of small effects are drawn, too
int speed(int draws, bool consider) {
  const Problem problem = six_signal_problem();
  calib::FitOptions options;
  options.consider = consider;
  double before = cpu_seconds();
  const calib::Fit alone = calib::fit(problem.campaign, problem.records, options);
  const double without_s = cpu_seconds() - before;
  options.posterior = draws;
  before = cpu_seconds();
  const calib::Fit fit = calib::fit(problem.campaign, problem.records, options);
  const double sampling_s = cpu_seconds() - before - without_s;
  if (!fit.posterior) return 1;
  double least = HUGE_VAL;
  for (const calib::FittedParameter& each : fit.parameters) {
    if (each.posterior) least = std::min(least, each.posterior->bulk_draws);
  }
  fmt::print("six signals, {} unknowns{}: {}\n", fit.posterior->names.size(),
             consider ? " and the small effects" : "", fit.posterior->message);
  fmt::print(
      "CPU {:.1f} s, {} evaluations, {:.2f} ms each; least bulk effective draws {:.0f}, "
      "{:.1f} per CPU second\n",
      sampling_s, fit.posterior->evaluations,
      1e3 * sampling_s / static_cast<double>(fit.posterior->evaluations), least,
      least / sampling_s);
  return alone.status == calib::FitStatus::converged ? 0 : 1;
}

/// Answers each line of sampler coordinates with the log density, and the words "centre" and
/// "covariance" with the corresponding values.
int replay() {
  const Problem problem = six_signal_problem();
  calib::FitOptions options;
  options.consider = false;
  const calib::Fit fit = calib::fit(problem.campaign, problem.records, options);
  std::vector<const datasets::Condition*> conditions;
  for (const auto& each : problem.campaign.conditions) conditions.push_back(&each);
  const calib::Problem fitted =
      calib::make_problem(problem.campaign, problem.records, conditions, false, nullptr);
  std::vector<double> z;
  for (std::size_t j = 0; j < fitted.map.unknowns().size(); ++j)
    z.push_back(fitted.map.to_unit(static_cast<int>(j), fit.parameters[j].value));
  const calib::Evaluation optimum =
      calib::evaluate_at(fitted, z, 1, {calib::Fidelity::full, nullptr, true});
  const calib::Uncertainty found = calib::uncertainty(fitted, optimum, *optimum.rows, 1);
  const calib::PosteriorDensity density(fitted, optimum, found, fit.parameters);
  const auto print = [](const auto& numbers) {
    for (const double each : numbers) fmt::print("{:.17g} ", each);
    fmt::print("\n");
    std::fflush(stdout);
  };
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "centre") {
      print(density.centre());
    } else if (line == "covariance") {
      print(density.covariance().reshaped());
    } else if (line == "cpu") {
      print(std::vector<double>{cpu_seconds()});
    } else {
      std::istringstream words(line);
      Eigen::VectorXd y(static_cast<Eigen::Index>(z.size()));
      for (double& each : y) words >> each;
      // No gradient is computed, because an ensemble sampler needs none.
      print(std::vector<double>{density.value(y)});
    }
  }
  return 0;
}

}  // namespace
}  // namespace rigcal::bench

int main(int count, char** arguments) {
  const std::string first = count > 1 ? arguments[1] : "500";
  const int second = count > 2 ? std::atoi(arguments[2]) : 0;
  if (first == "--speed") {
    const int draws = second > 0 ? second : 1000;
    return std::max(rigcal::bench::speed(draws, false), rigcal::bench::speed(draws, true));
  }
  if (first == "--replay") return rigcal::bench::replay();
  return rigcal::bench::study(std::atoi(first.c_str()), std::max(1, second), 1);
}
