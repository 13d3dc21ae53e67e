// Simulation-based calibration of the posterior (Talts et al., arXiv:1804.06788). Draws true values
// from the prior, generates records from them, and ranks each true value among the draws of its
// posterior. The ranks must be uniform. Prints the table in docs/uncertainty.md.
//
//   rigcal_posterior_study [campaigns] [threads] [seed] [file]
//   rigcal_posterior_study --speed [draws]
//   rigcal_posterior_study --replay
//
// The file stores the result of each campaign, so that a study that was stopped can continue. With
// --speed, samples the posterior for the six signals of the speed tests instead, and prints CPU
// time and effective draws. With --replay, reads lines of sampler coordinates and answers each with
// the log density, for samplers in other languages (bench/ensemble.py).
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/clock.hpp"
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
/// Tolerance of the solver in the fits. It moves an estimate by at most 2 % of its standard error
/// from that at 1e-8. A tighter one takes two to three times the CPU time.
constexpr double kFitTolerance = 1e-4;
/// Number of draws in each of the four chains.
constexpr int kDraws = 250;
/// Number of posterior draws among which a true value is ranked. Ranks among draws that depend on
/// each other are not uniform, so only one in ten is used. A draw is worth 0.2 to 1 independent
/// ones here, so that draws with nine others between them are nearly independent.
constexpr std::size_t kThinned = 100;
constexpr double kLevel = 0.01;  ///< probability below which ranks are not called uniform

/// Returns a campaign for the paper's rig with two short records and three unknowns, each bounded
/// by half and twice its usual value.
datasets::Campaign make_campaign(int number) {
  const model::ParameterValues usual = six_signal_truth();
  const auto table = model::parameter_table(usual.plant);
  datasets::Campaign campaign;
  campaign.file = fmt::format("campaign_{}", number);
  campaign.simulation.tolerance = kFitTolerance;
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

/// Result of one campaign. It has no ranks if the fit did not converge.
struct Ranked {
  std::vector<std::string> names;  ///< unknowns
  std::vector<int> ranks;          ///< number of draws below each true value, 0 to kThinned
  double r_hat = 0.0;
  int diverged = 0;
  double cpu_s = 0.0;  ///< CPU time of the fit, its posterior included
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
  options.posterior = kDraws;
  Ranked result;
  const double before_ms = thread_cpu_ms();
  const calib::Fit fit = calib::fit(campaign, records, options);
  result.cpu_s = 1e-3 * (thread_cpu_ms() - before_ms);
  if (fit.status != calib::FitStatus::converged || !fit.posterior) return result;
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
    result.ranks.push_back(below);
  }
  return result;
}

/// Stores the results of the campaigns so far in a text file, one line for each.
class KeptRanks {
 public:
  explicit KeptRanks(std::string file) : file_(std::move(file)) {
    if (file_.empty()) return;
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      const auto bar = line.find('|');
      if (bar != std::string::npos) lines_[line.substr(0, bar)] = line.substr(bar + 1);
    }
  }

  Ranked of(int number, std::uint64_t seed) {
    // The settings of the fit are part of the key, because results of other settings do not count.
    const std::string key =
        fmt::format("{} {} {} draws at {}", seed, number, kDraws, kFitTolerance);
    const auto line = lines_.find(key);
    if (line != lines_.end()) {
      if (const auto known = read(line->second)) return *known;
    }
    const Ranked made = rank_truths(number, seed);
    if (file_.empty()) return made;
    std::string text = fmt::format("{}|{} {} {} {}", key, made.ranks.size(), made.r_hat,
                                   made.diverged, made.cpu_s);
    for (std::size_t j = 0; j < made.ranks.size(); ++j)
      text += fmt::format(" {} {}", made.names[j], made.ranks[j]);
    const std::lock_guard lock(mutex_);
    std::ofstream(file_, std::ios::app) << text << "\n";
    return made;
  }

 private:
  /// Returns nothing if the line is incomplete.
  static std::optional<Ranked> read(const std::string& line) {
    std::istringstream in(line);
    Ranked result;
    std::size_t count = 0;
    in >> count >> result.r_hat >> result.diverged >> result.cpu_s;
    for (std::size_t j = 0; in && j < count; ++j) {
      result.names.emplace_back();
      in >> result.names.back() >> result.ranks.emplace_back();
    }
    return in ? std::optional(result) : std::nullopt;
  }

  std::string file_;
  std::map<std::string, std::string> lines_;
  std::mutex mutex_;
};

int bin_of(int rank) { return rank * kBins / (static_cast<int>(kThinned) + 1); }

/// Prints the counts of the ranks of one unknown and whether they are uniform.
///
/// @return  the chi-square probability of ranks that differ at least as much from uniform ones
double print_ranks(const std::string& name, const std::vector<int>& ranks) {
  std::vector<int> counts(kBins, 0);
  for (const int rank : ranks) ++counts[static_cast<std::size_t>(bin_of(rank))];
  // The 101 ranks cannot be divided equally among the bins.
  std::vector<double> expected(kBins, 0.0);
  for (int rank = 0; rank <= static_cast<int>(kThinned); ++rank)
    expected[static_cast<std::size_t>(bin_of(rank))] +=
        static_cast<double>(ranks.size()) / (kThinned + 1);
  double chi_squared = 0.0;
  std::string text;
  for (std::size_t b = 0; b < kBins; ++b) {
    chi_squared += (counts[b] - expected[b]) * (counts[b] - expected[b]) / expected[b];
    text += fmt::format("{}{}", b == 0 ? "" : " ", counts[b]);
  }
  const double p = metrics::chi_squared_exceedance(chi_squared, kBins - 1.0);
  fmt::print("| `{}` | {} | {:.1f} | {:.2g} |\n", name, text, chi_squared, p);
  return p;
}

/// @return  exit code: 1 if the ranks of an unknown are not uniform
int study(int campaigns, int threads, std::uint64_t seed, KeptRanks& kept) {
  std::vector<Ranked> all(static_cast<std::size_t>(campaigns));
  parallel_for(all.size(), threads,
               [&](std::size_t i) { all[i] = kept.of(static_cast<int>(i), seed); });
  std::vector<std::string> names;
  std::vector<std::vector<int>> ranks;
  std::vector<double> cpu_s;
  int lost = 0;
  int mixed = 0;
  int diverged = 0;
  for (const Ranked& each : all) {
    cpu_s.push_back(each.cpu_s);
    if (each.ranks.empty()) {
      ++lost;
      continue;
    }
    names = each.names;
    ranks.resize(names.size());
    for (std::size_t j = 0; j < names.size(); ++j) ranks[j].push_back(each.ranks[j]);
    mixed += each.r_hat <= 1.01 ? 1 : 0;
    diverged += each.diverged > 0 ? 1 : 0;
  }
  fmt::print(
      "{} campaigns, {} whose fit did not converge, {} with R-hat above 1.01, {} with "
      "divergences; CPU time of a fit: median {:.1f} s, largest {:.1f} s\n\n",
      campaigns, lost, campaigns - lost - mixed, diverged, median(cpu_s),
      *std::max_element(cpu_s.begin(), cpu_s.end()));
  fmt::print("| parameter | counts of the ranks, {} bins | chi-square | p |\n", kBins);
  fmt::print("| --- | --- | --- | --- |\n");
  bool uniform = true;
  for (std::size_t j = 0; j < names.size(); ++j)
    uniform = print_ranks(names[j], ranks[j]) > kLevel && uniform;
  return uniform ? 0 : 1;
}

/// Prints what the posterior of the six signals costs.
///
/// @param consider  whether the sizes of small effects are drawn, too
int speed(int draws, bool consider) {
  const Problem problem = six_signal_problem();
  calib::FitOptions options;
  options.consider = consider;
  double before_ms = cpu_ms();
  const calib::Fit alone = calib::fit(problem.campaign, problem.records, options);
  const double without_s = 1e-3 * (cpu_ms() - before_ms);
  options.posterior = draws;
  before_ms = cpu_ms();
  const calib::Fit fit = calib::fit(problem.campaign, problem.records, options);
  const double sampling_s = 1e-3 * (cpu_ms() - before_ms) - without_s;
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
      print(std::vector<double>{1e-3 * cpu_ms()});
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

int main(int argc, char** argv) {
  using namespace rigcal::bench;
  const std::string first = argc > 1 ? argv[1] : "500";
  const auto number = [&](int k, int otherwise) {
    return argc > k ? std::atoi(argv[k]) : otherwise;
  };
  if (first == "--speed" && argc <= 3 && number(2, 1000) > 0)
    return std::max(speed(number(2, 1000), false), speed(number(2, 1000), true));
  if (first == "--replay" && argc == 2) return replay();
  const int campaigns = std::atoi(first.c_str());
  const int threads = number(2, 1);
  const int seed = number(3, 1);
  if (campaigns < 1 || threads < 1 || seed < 1 || argc > 5) {
    std::cerr << "usage: rigcal_posterior_study [campaigns] [threads] [seed] [file that keeps]\n"
                 "       rigcal_posterior_study --speed [draws]\n"
                 "       rigcal_posterior_study --replay\n";
    return 2;
  }
  KeptRanks kept(argc > 4 ? argv[4] : "");
  return study(campaigns, threads, static_cast<std::uint64_t>(seed), kept);
}
