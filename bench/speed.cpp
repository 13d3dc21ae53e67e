// Prints figures in docs/quality.md as tables of CPU times, which are medians over interleaved
// rounds.
//
//   rigcal_speed [ROUNDS]           generated drives
//   rigcal_speed ROUNDS recorded    recorded drives
#include <fmt/format.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench/baseline.hpp"
#include "bench/clock.hpp"
#include "bench/problems.hpp"
#include "bench/two_chamber_record.hpp"
#include "calib/fit.hpp"
#include "calib/problem/measured_tolerance.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/multi_start.hpp"
#include "calib/search/search.hpp"
#include "common/memory.hpp"

namespace rigcal::bench {
namespace {

double wall_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

using Task = std::function<void()>;

/// Returns the median CPU time of each task. The tasks take turns.
std::vector<double> medians(const std::vector<Task>& tasks, int rounds,
                            double (*clock)() = cpu_ms) {
  std::vector<std::vector<double>> times(tasks.size());
  for (int r = 0; r < rounds; ++r) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const double begin = clock();
      tasks[i]();
      times[i].push_back(clock() - begin);
    }
  }
  std::vector<double> result;
  for (auto& each : times) result.push_back(median(each));
  return result;
}

std::vector<int> free_indices(const std::vector<const char*>& keys) {
  std::vector<int> free;
  for (const char* key : keys)
    free.push_back(model::parameter_index(model::PlantKind::load_pressure, key));
  return free;
}
const std::vector<const char*> kFour{"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"};

model::Simulation run(const model::ParameterValues& values, const std::vector<int>& free,
                      const Reference& reference, double tolerance, bool every_period = false) {
  model::SimulationOptions options;
  options.tolerance = tolerance;
  options.periodic_steady_state = !every_period;
  auto result = model::simulate({}, values, free, inputs(reference), sample_times(reference),
                                std::vector{model::Output::position}, options);
  if (!result.ok()) {
    fmt::print(stderr, "{}: {}\n", reference.waveform, result.reason);
    std::exit(1);
  }
  return result;
}

/// Result of the first part of a fit: the problem, solved from its start. The simulation that
/// assesses the optimum is not included, because it is needed for the intervals.
struct Solved {
  calib::Problem problem;
  calib::MultiStart found;
  long evaluations = 0;
};

Solved solve(const Problem& data, const calib::FitOptions& options) {
  std::vector<const datasets::Condition*> conditions;
  for (const auto& each : data.campaign.conditions) conditions.push_back(&each);
  Solved solved{
      calib::make_problem(data.campaign, data.records, conditions, false, nullptr), {}, 0};
  calib::Budget budget;
  calib::Evaluator evaluator(solved.problem, budget, options.threads);
  calib::measure_tolerances(solved.problem, solved.problem.start(), options.threads, nullptr);
  solved.found = calib::multi_start(solved.problem, evaluator, options);
  solved.evaluations = evaluator.counters().evaluations;
  return solved;
}

void require_converged(const calib::SolveResult& result) {
  if (result.status == calib::FitStatus::converged) return;
  fmt::print(stderr, "not converged: {}\n", result.message);
  std::exit(1);
}

/// Returns the largest difference between the parameters of a fit and other values, in standard
/// errors.
double distance_in_errors(const calib::Fit& fit, const std::vector<double>& other) {
  double worst = 0.0;
  std::size_t j = 0;
  for (const auto& each : fit.parameters) {
    if (!each.fitted) continue;
    worst = std::max(worst, std::abs(each.value - other[j++]) / each.standard_error.value_or(0.0));
  }
  return worst;
}

/// Returns the distance, in standard errors, between a fit to one draw of the noise and the optimum
/// with simulations at a tolerance of 1e-10.
double distance_of_draw(unsigned seed) {
  Problem data = six_signal_problem(seed);
  const Solved found = solve(data, {});
  require_converged(found.found.result);
  data.campaign.simulation.tolerance = 1e-10;
  const calib::Fit exact = calib::fit(data.campaign, data.records, {});
  return distance_in_errors(exact, found.problem.to_physical(found.found.optimum.z));
}

/// Tolerance at which rigcal's error is smaller than that of the baseline at 1e-6.
constexpr double kAsAccurate = 6e-5;

void six_signals(int rounds) {
  const auto truth = six_signal_truth();
  const auto free = free_indices(kFour);
  const baseline::Values ones{1.0, 1.0, 1.0, 1.0};
  const auto sweep = [&](const std::vector<int>& parameters, double tolerance,
                         bool every_period = false) {
    for (const auto& r : kSixSignals) run(truth, parameters, r, tolerance, every_period);
  };
  const auto times = medians({[&] {
                                for (const auto& r : kSixSignals) baseline::simulate(r, ones, 1e-6);
                              },
                              [&] { sweep({}, 1e-6); }, [&] { sweep({}, kAsAccurate); },
                              [&] {
                                for (const auto& r : kSixSignals)
                                  baseline::simulate_with_sensitivities(r, ones, 1e-6);
                              },
                              [&] { sweep(free, 1e-6); }, [&] { sweep(free, kAsAccurate); },
                              [&] { sweep({}, 1e-6, true); }, [&] { sweep(free, 1e-6, true); }},
                             rounds);
  std::vector<double> error(4, 0.0);
  for (const Reference& r : kSixSignals) {
    const auto exact = run(truth, {}, r, 1e-11, true).outputs;
    const auto theirs = baseline::simulate(r, ones, 1e-6);
    const Eigen::Map<const Eigen::VectorXd> other(theirs.data(), exact.rows());
    const double peak = exact.cwiseAbs().maxCoeff();
    const auto see = [&](std::size_t k, const Eigen::VectorXd& position) {
      error[k] = std::max(error[k], (position - exact.col(0)).cwiseAbs().maxCoeff() / peak);
    };
    see(0, other);
    see(1, run(truth, {}, r, 1e-6).outputs.col(0));
    see(2, run(truth, {}, r, kAsAccurate).outputs.col(0));
    see(3, run(truth, free, r, kAsAccurate).outputs.col(0));
  }

  const Problem data = six_signal_problem();
  std::vector<std::vector<double>> measured;
  for (const auto& record : data.records)
    measured.push_back(record.channels.at(datasets::Channel::position).mean);
  baseline::Fit theirs;
  std::optional<Solved> ours;
  calib::Fit whole;
  const auto fits = medians({[&] { theirs = baseline::fit(measured, kNoiseSd, 1e-7); },
                             [&] {
                               ours.emplace(solve(data, {}));
                               require_converged(ours->found.result);
                             },
                             [&] { whole = calib::fit(data.campaign, data.records, {}); }},
                            std::max(3, rounds / 3));
  Problem exact_data = data;
  exact_data.campaign.simulation.tolerance = 1e-10;
  const calib::Fit exact = calib::fit(exact_data.campaign, exact_data.records, {});
  std::vector<double> baseline_values;
  for (std::size_t j = 0; j < baseline::kFree; ++j)
    baseline_values.push_back(theirs.factors[j] * baseline::truth()[j]);
  // The unknowns are in the order of the parameter table: mass, bulk modulus, gain, leakage.

  fmt::print("### Six signals, 86 006 samples, one thread\n\n");
  fmt::print(
      "| CPU ms | baseline | rigcal | ratio | required | aim |\n| --- | --- | --- | --- | --- | "
      "--- |\n");
  const auto row = [](const char* name, double base, double mine, const char* required,
                      const char* aim) {
    fmt::print("| {} | {:.2f} | {:.2f} | 1/{:.1f} | {} | {} |\n", name, base, mine, base / mine,
               required, aim);
  };
  row("sweep at 1e-6", times[0], times[1], "1/2", "1/5");
  row("sweep as accurate as the baseline's", times[0], times[2], "1/2", "1/5");
  row("with four sensitivities at 1e-6", times[3], times[4], "1/4", "1/8");
  row("as accurate as the baseline", times[3], times[5], "1/4", "1/8");
  row("fit", fits[0], fits[1], "1/10", "1/25");
  row("fit, with intervals and scores", fits[0], fits[2], "", "");
  fmt::print(
      "\nWith every period simulated a sweep at 1e-6 takes {:.2f} ms, with four sensitivities "
      "{:.2f}.\n",
      times[6], times[7]);
  fmt::print(
      "Largest error of position, of its peak: baseline at 1e-6 {:.1e}, rigcal at 1e-6 {:.1e}; "
      "at {:.0e} {:.1e} (with sensitivities {:.1e}).\n",
      error[0], error[1], kAsAccurate, error[2], error[3]);
  fmt::print(
      "Evaluations of a fit: baseline {} with and {} without derivatives, rigcal {} (all but the "
      "first "
      "with). The simulation that verifies the optimum is in the row below.\n",
      theirs.jacobians / 6, theirs.residuals / 6, ours->evaluations);
  constexpr unsigned kDraws = 8;
  std::vector<double> distances;
  for (unsigned seed = 1; seed <= kDraws; ++seed) distances.push_back(distance_of_draw(seed));
  fmt::print(
      "Distance from the optimum of simulations at 1e-10, in standard errors: baseline {:.4f}, "
      "rigcal {:.4f}; of {} draws of the noise rigcal's median is {:.4f}, the largest {:.4f}.\n\n",
      distance_in_errors(exact, baseline_values),
      distance_in_errors(exact, ours->problem.to_physical(ours->found.optimum.z)), kDraws,
      median(distances), *std::max_element(distances.begin(), distances.end()));
}

/// Returns the references of the six signals as a laboratory would record them, with 0.05 mm of
/// noise in each sample.
std::vector<baseline::Recorded> recorded_signals(bool linear) {
  boost::random::mt19937 random(1);
  boost::random::normal_distribution<double> noise(0.0, 5e-5);
  std::vector<baseline::Recorded> result;
  for (const Reference& each : kSixSignals) {
    const model::Signal drive = inputs(each).drive;
    baseline::Recorded& recorded = result.emplace_back();
    recorded.linear = linear;
    for (const double t : sample_times(each))
      recorded.reference_m.push_back(drive.value(t) + noise(random));
  }
  return result;
}

model::Simulation run_recorded(const std::vector<int>& free, const Reference& reference,
                               const baseline::Recorded& recorded, double tolerance) {
  model::SimulationOptions options;
  options.tolerance = tolerance;
  const std::vector<double> times = sample_times(reference);
  model::SimulationInputs in;
  in.drive = recorded.linear ? model::Signal::linear(times, recorded.reference_m)
                             : model::Signal::held(times, recorded.reference_m);
  auto result = model::simulate({}, six_signal_truth(), free, in, times,
                                std::vector{model::Output::position}, options);
  if (!result.ok()) {
    fmt::print(stderr, "recorded: {}\n", result.reason);
    std::exit(1);
  }
  return result;
}

/// The fit of the six signals with recorded references, which drive the rig with their noise.
Problem recorded_problem(const std::vector<baseline::Recorded>& signals) {
  Problem data = six_signal_problem();
  datasets::ChannelSetting setting;
  setting.channel = datasets::Channel::reference;
  setting.role = datasets::ChannelRole::input;
  setting.interpolation =
      signals.front().linear ? datasets::Interpolation::linear : datasets::Interpolation::hold;
  data.campaign.channels[datasets::Channel::reference] = setting;
  boost::random::mt19937 random(2);
  boost::random::normal_distribution<double> noise(0.0, kNoiseSd);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    datasets::Condition& condition = data.campaign.conditions[i];
    condition.waveform = datasets::Waveform::recorded;
    condition.frequency_hz.reset();
    auto& channels = data.records[i].channels;
    channels[datasets::Channel::reference].mean = signals[i].reference_m;
    const auto exact = run_recorded({}, kSixSignals[i], signals[i], 1e-9).outputs;
    std::vector<double>& measured = channels[datasets::Channel::position].mean;
    for (std::size_t k = 0; k < measured.size(); ++k)
      measured[k] = exact(static_cast<Eigen::Index>(k), 0) + noise(random);
  }
  return data;
}

void recorded_fits(int rounds) {
  fmt::print(
      "| CPU ms of a fit | baseline | rigcal | ratio | evaluations of rigcal | standard errors "
      "from the optimum, baseline | rigcal |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const bool linear : {false, true}) {
    const auto signals = recorded_signals(linear);
    Problem data = recorded_problem(signals);
    std::vector<std::vector<double>> measured;
    for (const auto& record : data.records)
      measured.push_back(record.channels.at(datasets::Channel::position).mean);
    baseline::Fit theirs;
    std::optional<Solved> ours;
    calib::FitOptions plain;
    plain.consider = false;
    const auto times = medians({[&] { theirs = baseline::fit(signals, measured, kNoiseSd, 1e-7); },
                                [&] {
                                  ours.emplace(solve(data, {}));
                                  require_converged(ours->found.result);
                                },
                                [&] { calib::fit(data.campaign, data.records, plain); }},
                               rounds);
    std::vector<double> baseline_values;
    for (std::size_t j = 0; j < baseline::kFree; ++j)
      baseline_values.push_back(theirs.factors[j] * baseline::truth()[j]);
    data.campaign.simulation.tolerance = 1e-9;
    const calib::Fit exact = calib::fit(data.campaign, data.records, plain);
    const double distance =
        distance_in_errors(exact, ours->problem.to_physical(ours->found.optimum.z));
    const auto row = [&](const char* name, double mine) {
      fmt::print("| {}{} | {:.0f} | {:.0f} | 1/{:.1f} | {} | {:.4f} | {:.4f} |\n",
                 linear ? "linear" : "held", name, times[0], mine, times[0] / mine,
                 ours->evaluations, distance_in_errors(exact, baseline_values), distance);
    };
    row("", times[1]);
    row(", with intervals and scores", times[2]);
  }
  fmt::print("\n");
}

void recorded_drives(int rounds) {
  const auto free = free_indices(kFour);
  const baseline::Values ones{1.0, 1.0, 1.0, 1.0};
  fmt::print("### The six signals with a recorded reference, 0.05 mm of noise on it\n\n");
  fmt::print(
      "| CPU ms | baseline | rigcal | ratio | error of position, baseline | rigcal |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  for (const bool linear : {false, true}) {
    const auto signals = recorded_signals(linear);
    const auto sweep = [&](const std::vector<int>& parameters, double tolerance) {
      for (std::size_t i = 0; i < signals.size(); ++i)
        run_recorded(parameters, kSixSignals[i], signals[i], tolerance);
    };
    std::vector<Eigen::VectorXd> exact;
    double theirs = 0.0;
    const auto error_of = [&](std::size_t i, const Eigen::VectorXd& position) {
      return (position - exact[i]).cwiseAbs().maxCoeff() / exact[i].cwiseAbs().maxCoeff();
    };
    for (std::size_t i = 0; i < signals.size(); ++i) {
      exact.emplace_back(run_recorded({}, kSixSignals[i], signals[i], 1e-10).outputs.col(0));
      const auto other = baseline::simulate(signals[i], ones, 1e-6);
      theirs = std::max(theirs, error_of(i, Eigen::Map<const Eigen::VectorXd>(
                                                other.data(), exact.back().size())));
    }
    const auto ours = [&](const std::vector<int>& parameters, double tolerance) {
      double worst = 0.0;
      for (std::size_t i = 0; i < signals.size(); ++i)
        worst = std::max(
            worst,
            error_of(
                i, run_recorded(parameters, kSixSignals[i], signals[i], tolerance).outputs.col(0)));
      return worst;
    };
    // The coarsest tolerance at which rigcal's error is smaller than that of the baseline at 1e-6.
    double as_accurate = 1e-3;
    while (as_accurate > 1e-6 && std::max(ours({}, as_accurate), ours(free, as_accurate)) > theirs)
      as_accurate *= 0.5;
    const auto times = medians({[&] {
                                  for (const auto& each : signals)
                                    baseline::simulate(each, ones, 1e-6);
                                },
                                [&] { sweep({}, 1e-6); }, [&] { sweep({}, as_accurate); },
                                [&] {
                                  for (const auto& each : signals)
                                    baseline::simulate_with_sensitivities(each, ones, 1e-6);
                                },
                                [&] { sweep(free, 1e-6); }, [&] { sweep(free, as_accurate); }},
                               rounds);
    const auto row = [&](const std::string& name, double base, double mine, double error) {
      fmt::print("| {}, {} | {:.1f} | {:.1f} | 1/{:.1f} | {:.1e} | {:.1e} |\n",
                 linear ? "linear" : "held", name, base, mine, base / mine, theirs, error);
    };
    row("sweep at 1e-6", times[0], times[1], ours({}, 1e-6));
    row("sweep as accurate as the baseline's", times[0], times[2], ours({}, as_accurate));
    row("with four sensitivities at 1e-6", times[3], times[4], ours(free, 1e-6));
    row("as accurate as the baseline", times[3], times[5], ours(free, as_accurate));
  }
  fmt::print("\n");
  recorded_fits(std::max(1, rounds / 5));
}

void stiff(int rounds) {
  Problem data = stiff_problem();
  const auto free = free_indices(kFour);
  const auto sweep = [&](const std::vector<int>& parameters, bool every_period = false) {
    for (std::size_t i = 0; i < data.truth.size(); ++i)
      run(data.truth[i], parameters, kPaperSignals[i % kPaperSignals.size()], 1e-6, every_period);
  };
  const auto times =
      medians({[&] { sweep({}); }, [&] { sweep(free); }, [&] { sweep(free, true); }}, rounds);
  std::optional<Solved> solved;
  const auto fits = medians({[&] {
                              solved.emplace(solve(data, {}));
                              require_converged(solved->found.result);
                            }},
                            std::max(3, rounds / 5));
  const std::vector<double> optimum = solved->found.optimum.z;
  std::vector<double> refits;
  for (unsigned seed = 2; seed < 5; ++seed) {
    draw_noise(data, seed);
    std::vector<const datasets::Condition*> conditions;
    for (const auto& each : data.campaign.conditions) conditions.push_back(&each);
    const auto problem =
        calib::make_problem(data.campaign, data.records, conditions, false, nullptr);
    calib::Budget budget;
    calib::Evaluator evaluator(problem, budget);
    const double begin = cpu_ms();
    const calib::FitOptions settings;
    require_converged(calib::Search(problem, evaluator, settings).polish(optimum));
    refits.push_back(cpu_ms() - begin);
  }
  fmt::print("### Stiff campaign: 24 records, 344 024 samples, seven parameters, one thread\n\n");
  fmt::print("| | CPU ms | estimate of what is possible |\n| --- | --- | --- |\n");
  fmt::print("| sweep at 1e-6 | {:.0f} | |\n", times[0]);
  fmt::print("| with sensitivities (four act in each record) | {:.0f} | 80 |\n", times[1]);
  fmt::print("| the same, every period simulated | {:.0f} | |\n", times[2]);
  fmt::print("| fit, {} evaluations | {:.0f} | 600 |\n", solved->evaluations, fits[0]);
  const double refit = median(refits);
  fmt::print("| refit from the optimum | {:.0f} | |\n", refit);
  fmt::print("| 1000 refits on two cores, min | {:.1f} | 3 |\n\n", refit * 1000.0 / 2.0 / 60e3);
}

/// Measures simulations of a 20 s record at 10 kHz whose recorded command drives the valve.
void long_record(int rounds) {
  const auto truth = six_signal_truth();
  const auto free = free_indices({"mass", "damping", "stiffness", "piston_area", "total_volume",
                                  "supply_pressure", "bulk_modulus", "valve_gain",
                                  "leakage_coefficient", "leakage_area"});
  model::Rig rig;
  rig.controller = model::ControllerKind::none;
  std::vector<double> times;
  std::vector<double> every;
  for (int k = 0; k <= 200'000; ++k) {
    times.push_back(k / 1e4);
    every.push_back(0.5 * std::sin(9.0 * times.back()) + 0.2 * std::sin(61.0 * times.back()));
  }
  const auto simulate = [&](const model::Signal& command) {
    model::SimulationInputs in;
    in.drive = command;
    const auto result =
        model::simulate(rig, truth, free, in, times, std::vector{model::Output::position});
    if (!result.ok()) {
      fmt::print(stderr, "{}\n", result.reason);
      std::exit(1);
    }
  };
  const auto changing = model::Signal::held(times, every);
  const auto steps = model::Signal::held({0.0, 4.0, 8.0, 12.0, 16.0}, {0.5, -0.5, 0.3, -0.3, 0.1});
  const auto result =
      medians({[&] { simulate(changing); }, [&] { simulate(steps); }}, std::max(3, rounds / 5));
  fmt::print("### A record of 20 s at 10 kHz with sensitivities to ten parameters\n\n");
  fmt::print("| command | CPU ms | required |\n| --- | --- | --- |\n");
  fmt::print("| changes at every sample | {:.0f} | 1000 |\n| five steps | {:.0f} | 200 |\n\n",
             result[0], result[1]);
}

struct Point {
  std::string of;
  double ms = 0.0;
};

/// Prints a table with a bar for each figure.
void draw(const std::string& title, const std::string& head, const std::vector<Point>& points) {
  double longest = 0.0;
  for (const Point& each : points) longest = std::max(longest, each.ms);
  fmt::print("{}\n\n| {} | ms | |\n| --- | --- | --- |\n", title, head);
  for (const Point& each : points) {
    std::string bar;
    for (int k = 0; k < static_cast<int>(30.0 * each.ms / longest + 0.5); ++k) bar += "\u2588";
    fmt::print("| {} | {:.2f} | {} |\n", each.of, each.ms, bar);
  }
  fmt::print("\n");
}

/// Returns the problem with every condition repeated `copies` times.
Problem repeated(const Problem& data, int copies) {
  Problem more = data;
  for (int c = 1; c < copies; ++c) {
    for (std::size_t i = 0; i < data.records.size(); ++i) {
      more.campaign.conditions.push_back(data.campaign.conditions[i]);
      more.records.push_back(data.records[i]);
      more.campaign.conditions.back().id += fmt::format("_{}", c);
      more.records.back().condition = more.campaign.conditions.back().id;
    }
  }
  return more;
}

void growth(int rounds) {
  const auto truth = six_signal_truth();
  fmt::print("### Growth\n\n");
  std::vector<Point> points;
  for (const bool every_period : {true, false}) {
    points.clear();
    for (const double duration : {5.0, 10.0, 20.0, 40.0, 80.0}) {
      const Reference reference{"sine", 1.0, 0.02, duration};
      const auto free = free_indices(kFour);
      points.push_back(
          {fmt::format("{:.0f}", duration * 1000.0 + 1.0),
           medians({[&] { run(truth, free, reference, 1e-6, every_period); }}, rounds)[0]});
    }
    draw(fmt::format("With samples: a 1 Hz sine with four sensitivities, CPU time{}.",
                     every_period ? ", every period simulated"
                                  : ", read from its last period once it repeats itself"),
         "samples", points);
  }

  const std::vector<const char*> all{"mass",
                                     "bulk_modulus",
                                     "valve_gain",
                                     "leakage_coefficient",
                                     "damping",
                                     "stiffness",
                                     "piston_area",
                                     "total_volume",
                                     "supply_pressure",
                                     "density",
                                     "leakage_area",
                                     "kp"};
  points.clear();
  for (const std::ptrdiff_t count : {0, 4, 8, 12}) {
    const auto free = free_indices({all.begin(), all.begin() + count});
    const Task sweep = [&] {
      for (const auto& r : kSixSignals) run(truth, free, r, 1e-6);
    };
    points.push_back({std::to_string(count), medians({sweep}, rounds)[0]});
  }
  draw("With parameters: sweep over the six signals, CPU time.", "sensitivities", points);

  const Problem data = six_signal_problem();
  const int few = std::max(3, rounds / 3);
  points.clear();
  for (const int copies : {1, 2, 3, 4}) {
    const Problem more = repeated(data, copies);
    points.push_back(
        {std::to_string(more.records.size()), medians({[&] { solve(more, {}); }}, few)[0]});
  }
  draw("With conditions: fit of the six signals, each given once or more, CPU time.", "conditions",
       points);

  points.clear();
  const Problem more = repeated(data, 4);
  for (const int threads : {1, 2, 4}) {
    calib::FitOptions options;
    options.threads = threads;
    points.push_back(
        {std::to_string(threads), medians({[&] { solve(more, options); }}, few, wall_ms)[0]});
  }
  draw(fmt::format("With threads, on {} cores: fit of the 24 conditions, wall time.",
                   std::thread::hardware_concurrency()),
       "threads", points);
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  using namespace rigcal::bench;
  rigcal::keep_freed_memory();
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 15;
  if (rounds < 1) {
    fmt::print(stderr, "usage: rigcal_speed [rounds [recorded]]\n");
    return 2;
  }
  if (argc > 2 && std::string(argv[2]) == "recorded") {
    recorded_drives(rounds);
    return 0;
  }
  six_signals(rounds);
  stiff(rounds);
  long_record(rounds);
  two_chamber_record(rounds);
  growth(rounds);
}
