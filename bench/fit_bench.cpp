#include <benchmark/benchmark.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>

#include "bench/six_signals.hpp"
#include "calib/fit.hpp"

namespace rigcal::bench {

SixSignalCampaign six_signal_campaign() {
  constexpr double kNoiseSd = 0.05e-3 / 2.2360679774997896;  // five repeats averaged
  const model::ParameterValues truth = six_signal_truth();
  SixSignalCampaign result;
  result.campaign.name = "six signals";
  const auto table = model::parameter_table(truth.plant);
  const std::vector<std::pair<const char*, double>> starts{
      {"mass", 0.6}, {"bulk_modulus", 1.5}, {"valve_gain", 0.7}, {"leakage_coefficient", 2.0}};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!truth.given[i]) continue;
    datasets::ParameterSetting setting;
    setting.index = static_cast<int>(i);
    setting.value = truth.value[i];
    for (const auto& [key, factor] : starts) {
      if (table[i].key != key) continue;
      setting.fit = true;
      setting.lower = truth.value[i] / 5.0;
      setting.upper = truth.value[i] * 5.0;
      setting.value = truth.value[i] * factor;
    }
    result.campaign.parameters.push_back(setting);
  }
  datasets::ChannelSetting position;
  position.channel = datasets::Channel::position;
  position.column = "x_m";
  result.campaign.channels[datasets::Channel::position] = position;

  boost::random::mt19937_64 engine(1);
  boost::random::normal_distribution<double> noise(0.0, kNoiseSd);
  for (const SixSignal& signal : kSixSignals) {
    datasets::Condition condition;
    condition.id = signal.waveform + "_" + std::to_string(signal.frequency_hz);
    condition.waveform =
        signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
    condition.frequency_hz = signal.frequency_hz;
    condition.amplitude = signal.amplitude_m;
    result.campaign.conditions.push_back(condition);
    datasets::Record record;
    record.condition = condition.id;
    record.time_s = sample_times(signal);
    const std::vector<model::Output> outputs{model::Output::position};
    model::SimulationOptions options;
    options.tolerance = 1e-9;
    const auto run =
        model::simulate({}, truth, {}, inputs(signal), record.time_s, outputs, options);
    datasets::Series series;
    for (Eigen::Index k = 0; k < run.outputs.rows(); ++k) {
      series.mean.push_back(run.outputs(k, 0) + noise(engine));
    }
    series.count.assign(series.mean.size(), 5);
    series.repeats = 5;
    series.pooled_sd = 0.05e-3;
    series.sd_of_mean = kNoiseSd;
    record.channels[datasets::Channel::position] = series;
    record.repeats = 5;
    result.records.push_back(record);
  }
  return result;
}

namespace {

void fit_six_signals(benchmark::State& state) {
  const SixSignalCampaign problem = six_signal_campaign();
  calib::FitOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const calib::Fit fit = calib::fit(problem.campaign, problem.records, options);
    if (fit.status != calib::FitStatus::converged) {
      state.SkipWithError(fit.message.c_str());
      return;
    }
    state.counters["evaluations"] = static_cast<double>(fit.evaluations);
    benchmark::DoNotOptimize(fit.cost);
  }
}
BENCHMARK(fit_six_signals)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace rigcal::bench
