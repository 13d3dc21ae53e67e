// Tests the predictions of `plan --design` for the paper's rig. Designs a drive for the bulk
// modulus within the limits that the paper's six signals reach, compares the predicted interval
// with that of the six signals in the same total time, and fits many records of the drive. Prints
// the tables in docs/plan-design.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "calib/design/design.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/synthetic/noise.hpp"
#include "datasets/synthetic/synthesize.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kNoiseOfOneRepeat = 0.05e-3;  // standard deviation of one repeat [m]
constexpr int kRepeatsOfDesign = 5;
constexpr double kStartsOff = 1.1;

/// Returns the shipped campaign at its true values, because a plan is usually made with values from
/// a first fit.
datasets::Campaign at_truth(const std::string& like) {
  datasets::Campaign campaign = datasets::true_campaign(datasets::load_campaign(
      std::string(RIGCAL_SOURCE_DIR) + "/datasets/rigs/uis_shake_table/campaign.toml"));
  const std::string level = campaign.find(like)->leak_level.value();
  // The true value of the level becomes the start value of its unknown.
  auto& levels = campaign.leak_levels[level];
  for (const auto& [index, value] : levels) {
    for (auto& setting : campaign.parameters)
      if (setting.index == index) setting.value = value;
  }
  for (auto& each : campaign.leak_levels) each.second.clear();
  std::erase_if(campaign.conditions,
                [&](const datasets::Condition& each) { return each.leak_level != level; });
  return campaign;
}

/// Returns the limits that the campaign's own signals reach.
datasets::DesignSettings limits_of_own_signals(const datasets::Campaign& campaign,
                                               double duration_s) {
  datasets::DesignSettings settings;
  double lowest = 0.0;
  double highest = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
  double command = 0.0;
  double flow = 0.0;
  for (const datasets::Condition& condition : campaign.conditions) {
    const auto values = datasets::values_in(campaign, condition);
    const auto times = datasets::sample_times(condition, nullptr);
    const auto run = model::simulate(campaign.rig, values, {},
                                     datasets::inputs_of(campaign, condition, values, nullptr),
                                     times, calib::limited_outputs());
    if (!run.ok()) throw std::runtime_error(run.reason);
    lowest = std::min(lowest, run.outputs.col(0).minCoeff());
    highest = std::max(highest, run.outputs.col(0).maxCoeff());
    const auto largest = [&](Eigen::Index column, double& most) {
      most = std::max(most, run.outputs.col(column).cwiseAbs().maxCoeff());
    };
    largest(1, speed);
    largest(2, acceleration);
    largest(3, command);
    largest(4, flow);
  }
  settings.lowest_m.value = lowest;
  settings.highest_m.value = highest;
  settings.speed_m_per_s = datasets::StatedLimit{speed, {}};
  settings.acceleration_m_per_s2 = datasets::StatedLimit{acceleration, {}};
  settings.command_v = datasets::StatedLimit{command, {}};
  settings.flow_m3_per_s = datasets::StatedLimit{flow, {}};
  settings.duration_s = duration_s;
  settings.sample_rate_hz = 1000.0;
  settings.repeats = kRepeatsOfDesign;
  settings.noise_sd[Channel::position] = kNoiseOfOneRepeat;
  return settings;
}

double half_width_percent(double sd, double value) {
  return 100.0 * metrics::kNormal95 * sd / std::abs(value);
}

void print_design(const calib::Design& design) {
  std::cout << fmt::format("family: {}\n", datasets::to_string(design.family));
  for (const calib::DrivePart& part : design.drive)
    std::cout << fmt::format("  {} {:.5g} {}\n", part.name, part.value, part.unit);
  for (const calib::LimitUse& use : design.limits)
    std::cout << fmt::format("  {}: {:.4g} of {:.4g} {}\n", use.words, use.reached, use.limit,
                             use.unit);
  std::cout << "| parameter | this test, % | six signals, % | ratio |\n| --- | --- | --- | --- |\n";
  for (const calib::DesignedParameter& each : design.parameters) {
    const double own = half_width_percent(each.sd_own_signals.value_or(NAN), each.value);
    const double now = half_width_percent(each.sd.value_or(NAN), each.value);
    std::cout << fmt::format("| {}{} | {:.3g} | {:.3g} | {:.2f} |\n", each.name,
                             each.named ? " (designed for)" : "", now, own, own / now);
  }
  std::cout << "| family | bulk modulus, % |\n| --- | --- |\n";
  for (const calib::FamilyTrial& trial : design.families) {
    for (std::size_t j = 0; j < trial.sd.size(); ++j)
      if (design.parameters[j].named && trial.sd[j])
        std::cout << fmt::format("| {} | {:.3g} |\n", datasets::to_string(trial.family),
                                 half_width_percent(*trial.sd[j], design.parameters[j].value));
  }
  std::cout << std::flush;
}

/// Fits many records of the drive as the controller plays it, and prints how the estimates vary.
void print_spread(const calib::Design& design, datasets::Campaign campaign, int fits, int threads) {
  const std::string like = *campaign.design->like;
  datasets::Condition condition;
  condition.id = "design";
  condition.waveform = datasets::Waveform::recorded;
  condition.leak_level = campaign.find(like)->leak_level;
  campaign.conditions = {condition};
  datasets::ChannelSetting& drive = campaign.channels[Channel::reference];
  drive.channel = Channel::reference;
  drive.role = datasets::ChannelRole::input;
  drive.recognise = false;
  for (auto& setting : campaign.parameters)
    if (setting.fit) setting.value *= kStartsOff;
  const double sd = kNoiseOfOneRepeat / std::sqrt(kRepeatsOfDesign);
  std::vector<std::vector<double>> errors(static_cast<std::size_t>(fits));
  parallel_for(errors.size(), threads, [&](std::size_t i) {
    auto stream = datasets::random_stream(i + 1, {"design study"});
    datasets::Record record;
    record.condition = "design";
    record.time_s = design.time_s;
    record.repeats = kRepeatsOfDesign;
    datasets::Series position;
    position.mean = datasets::white_noise(stream, design.time_s.size(), sd);
    for (std::size_t k = 0; k < position.mean.size(); ++k)
      position.mean[k] += design.response(static_cast<Eigen::Index>(k), 0);
    position.sd_of_mean = sd;
    record.channels[Channel::position] = std::move(position);
    record.channels[Channel::reference].mean = design.samples;
    calib::FitOptions options;
    options.consider = false;
    options.further_starts = 3;  // as in a plain `rigcal fit`
    const calib::Fit fit = calib::fit(campaign, {record}, options);
    if (fit.status != calib::FitStatus::converged) return;
    for (std::size_t j = 0; j < design.parameters.size(); ++j)
      errors[i].push_back(fit.parameters[j].value - design.parameters[j].value);
  });
  const auto failed =
      std::count_if(errors.begin(), errors.end(), [](const auto& each) { return each.empty(); });
  std::cout << fmt::format(
      "{} fits, {} of them not converged\n| parameter | predicted sd | sd of the fits | ratio | "
      "mean "
      "error over sd |\n| --- | --- | --- | --- | --- |\n",
      fits, failed);
  for (std::size_t j = 0; j < design.parameters.size(); ++j) {
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const auto& each : errors) {
      if (each.empty()) continue;
      sum += each[j];
      squares += each[j] * each[j];
      n += 1.0;
    }
    const double spread = std::sqrt((squares - sum * sum / n) / (n - 1.0));
    const double predicted = design.parameters[j].sd.value_or(NAN);
    std::cout << fmt::format("| {} | {:.4g} | {:.4g} | {:.3f} | {:.2f} |\n",
                             design.parameters[j].name, predicted, spread, spread / predicted,
                             sum / n / spread);
  }
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const int fits = argc > 1 ? std::atoi(argv[1]) : 200;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const double duration_s = argc > 3 ? std::atof(argv[3]) : 20.0;
  const int evaluations = argc > 4 ? std::atoi(argv[4]) : 200;
  if (fits < 2 || threads < 1 || !(duration_s >= 1.0) || evaluations < 1 || argc > 5) {
    std::cerr << "usage: rigcal_design_study [fits] [threads] [seconds] [drives of a family]\n";
    return 2;
  }
  using namespace rigcal;
  const std::string like = "sine_1Hz_open_33";
  datasets::Campaign campaign = bench::at_truth(like);
  campaign.design = bench::limits_of_own_signals(campaign, duration_s);
  campaign.design->like = like;
  campaign.design->evaluations = evaluations;
  const calib::Design design =
      calib::design(campaign, {}, {"bulk_modulus"}, nullptr, {threads, nullptr, {}});
  bench::print_design(design);
  bench::print_spread(design, campaign, fits, threads);
  return 0;
}
