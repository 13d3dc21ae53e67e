#include "calib/search/multi_start.hpp"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <limits>
#include <numeric>

#include "calib/search/basins.hpp"
#include "calib/search/checkpoint.hpp"
#include "common/bytes.hpp"
#include "common/error.hpp"
#include "common/task_farm.hpp"

namespace rigcal::calib {

template <typename Archive>
void serialize(Archive& archive, StartReport& report) {
  archive(report.number, report.start_values, report.end_values, report.initial_cost,
          report.final_cost, report.iterations, report.status, report.message);
}

template <typename Archive>
void serialize(Archive& archive, SimulationFailure& failure) {
  archive(failure.condition, failure.parameters, failure.time_s, failure.reason, failure.status,
          failure.start);
}

template <typename Archive>
void serialize(Archive& archive, EvaluationCounters& counters) {
  archive(counters.evaluations, counters.failure_count, counters.failures, counters.kept);
}

namespace {

/// Maximum number of iterations for a start that is evaluated only coarsely.
constexpr int kLookIterations = 30;
/// Two minima are different if their costs differ by more than the sum of two tolerances:
/// kCoarseCost is the error of coarse simulations as a fraction of the cost, and kFurtherCost is in
/// variances of a residual.
constexpr double kCoarseCost = 1e-3;
constexpr double kFurtherCost = 2.0;

/// Returns a uniformly distributed number in [0, 1) with 53 bits. std::uniform_real_distribution
/// would give different numbers with different standard libraries.
double uniform(boost::random::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Returns the campaign's start values, followed by `count - 1` points of a latin hypercube.
std::vector<std::vector<double>> start_points(const Problem& problem, int count,
                                              std::uint64_t seed) {
  const auto& unknowns = problem.map.unknowns();
  std::vector<std::size_t> varied;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    if (!unknowns[j].nuisance) varied.push_back(j);
  }
  std::vector<std::vector<double>> points{problem.start()};
  const auto others = static_cast<std::size_t>(count - 1);
  for (const auto& sample : latin_hypercube(others, varied.size(), seed)) {
    points.push_back(points.front());
    for (std::size_t k = 0; k < varied.size(); ++k) points.back()[varied[k]] = sample[k];
  }
  return points;
}

/// Returns the variance of the weighted residuals for a given cost; at least 1 if the noise is
/// known.
double residual_variance(const Problem& problem, double cost) {
  const auto freedom = problem.residual_count() - static_cast<long>(problem.map.unknowns().size());
  const double variance = 2.0 * cost / static_cast<double>(std::max(1L, freedom));
  return problem.has_estimated_sd() ? variance : std::max(1.0, variance);
}

/// Stores the result of a search in the report.
void report_end(const Problem& problem, const SolveResult& solved, const Evaluation& end,
                StartReport& report) {
  report.status = solved.status;
  report.message = solved.message;
  report.iterations = solved.iterations;
  if (!end.ok) return;
  report.end_values = problem.to_physical(end.z);
  report.final_cost = end.cost;
}

/// Runs one start. Its end point is the evaluator's best point.
StartReport make_start(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                       int number, const std::vector<double>& from, SolveResult& solved) {
  evaluator.begin_start(number);
  evaluator.set_fidelity(problem.of_starts());
  StartReport report;
  report.number = number;
  report.start_values = problem.to_physical(from);
  const Evaluation& first = evaluator.evaluate(from);
  report.initial_cost = first.ok ? first.cost : StartReport::kNone;
  solved = Search(problem, evaluator, options, number).run(from);
  report_end(problem, solved, evaluator.best(), report);
  return report;
}

/// Returns true if a start whose end point could be simulated is better than all previous starts.
bool is_best(const MultiStart& before, const StartReport& report, const Problem& problem) {
  if (before.best == 0) return true;
  const StartReport& best = before.starts[static_cast<std::size_t>(before.best) - 1];
  const double least = std::min(report.final_cost, best.final_cost);
  return better_start(report, best, residual_variance(problem, least));
}

/// Copies the status and message of the best start, or of the first if none could be simulated, and
/// evaluates its end point.
void describe_best(const Problem& problem, const std::vector<double>& best_z, int threads,
                   MultiStart& found) {
  if (found.starts.empty()) return;
  const bool any = found.best > 0;
  const StartReport& report = found.starts[any ? static_cast<std::size_t>(found.best) - 1 : 0];
  found.result.status = report.status;
  found.result.message = report.message;
  found.result.iterations = report.iterations;
  if (!any) return;
  if (best_z.size() == problem.map.unknowns().size())
    found.optimum = evaluate_at(problem, best_z, threads, {Fidelity::full, nullptr, true});
  if (found.optimum.ok) found.result.check = check_optimum(problem, found.optimum);
}

/// Restores the state after the last start in a checkpoint, and evaluates the best point again.
MultiStart resumed(const Problem& problem, Evaluator& evaluator, const FitOptions& options) {
  const Checkpoint& from = *options.resume;
  MultiStart result;
  result.starts = from.starts;
  result.best = from.best;
  evaluator.set_counters(from.counters);
  describe_best(problem, from.best_z, options.threads, result);
  if (result.best > 0 && !result.optimum.ok) {
    throw InputError({"checkpoint"},
                     "its best point cannot be simulated: expected one of this fit");
  }
  return result;
}

/// Runs the starts one after the other.
void make_in_turn(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                  const std::vector<std::vector<double>>& points, MultiStart& found) {
  for (std::size_t i = found.starts.size(); i < points.size(); ++i) {
    if (i > 0 && evaluator.budget().spent()) break;
    SolveResult solved;
    StartReport report =
        make_start(problem, evaluator, options, static_cast<int>(i) + 1, points[i], solved);
    if (evaluator.best().ok) {
      if (is_best(found, report, problem)) {
        found.best = report.number;
        found.optimum = evaluator.best();
        found.result = solved;
      }
    } else if (found.best == 0 && i == 0) {
      found.result = solved;
    }
    found.starts.push_back(std::move(report));
    // An interrupted start is repeated after resuming.
    if (options.checkpoint && !evaluator.budget().spent())
      options.checkpoint({found.starts, found.best, found.optimum.z, evaluator.counters()});
  }
}

/// Runs the starts in parallel in the processes of a farm. The results are bitwise identical to
/// those of make_in_turn(), because each start begins with the evaluator's state before the first
/// start.
void make_in_farm(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                  const std::vector<std::vector<double>>& points, TaskFarm& farm,
                  MultiStart& found) {
  const std::size_t first = found.starts.size();
  const auto make = [&](std::size_t i) -> TaskResult {
    if (first + i > 0 && evaluator.budget().spent()) return {{}, false};
    Budget part = evaluator.budget().part();
    Evaluator own(evaluator, part);
    SolveResult solved;
    const StartReport report = make_start(problem, own, options, static_cast<int>(first + i) + 1,
                                          points[first + i], solved);
    return {to_bytes(report, own.best().ok ? own.best().z : std::vector<double>(), own.counters()),
            !own.budget().spent()};
  };
  const FarmJob job{"starts", to_bytes(points.front(), options.seed, points.size(), first),
                    points.size() - first, 1};
  std::vector<double> best_z = found.optimum.z;
  for (const TaskResult& made : farm.run(job, make, {})) {
    if (made.bytes.empty()) break;
    StartReport report;
    std::vector<double> end;
    EvaluationCounters counters;
    from_bytes(made.bytes, report, end, counters);
    evaluator.add(counters);
    if (!end.empty() && is_best(found, report, problem)) {
      found.best = report.number;
      best_z = std::move(end);
    }
    found.starts.push_back(std::move(report));
    if (!made.whole) break;
  }
  describe_best(problem, best_z, options.threads, found);
}

/// End point of a start that was searched with coarse simulations.
struct Approach {
  std::size_t start = 0;
  std::vector<double> end;
  /// Predicted cost after the remaining step, from coarse simulations of whole records.
  double cost = 0.0;
};

/// Evaluates further starts coarsely. Those that lead to a lower cost than the first start are then
/// searched fully.
void look_around(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                 MultiStart& found) {
  FitOptions coarsely = options;
  coarsely.progress = nullptr;
  coarsely.max_iterations = std::min(options.max_iterations, kLookIterations);
  const auto points = start_points(problem, 1 + options.further_starts, options.seed);
  // The predicted reduction by one more Gauss-Newton step is subtracted from the cost, because an
  // approach may end some standard errors away from its minimum.
  const auto coarse_cost = [&](const std::vector<double>& z) {
    evaluator.set_fidelity(Fidelity::coarse);
    const Evaluation& there = evaluator.evaluate(z);
    return there.ok ? there.cost * (1.0 - check_optimum(problem, there).reducible)
                    : std::numeric_limits<double>::infinity();
  };
  double least = coarse_cost(found.optimum.z);
  FurtherStarts& looks = found.further_starts.emplace();
  std::vector<Approach> approaches;
  for (std::size_t i = 1; i < points.size() && !evaluator.budget().spent(); ++i) {
    evaluator.begin_start(static_cast<int>(i) + 1);
    ++looks.looked_at;
    if (!Search(problem, evaluator, coarsely, static_cast<int>(i) + 1).approach(points[i]))
      continue;
    const std::vector<double> end = evaluator.best().z;
    approaches.push_back({i, end, coarse_cost(end)});
  }
  std::stable_sort(approaches.begin(), approaches.end(),
                   [](const Approach& a, const Approach& b) { return a.cost < b.cost; });
  const auto margin = [&](double cost) {
    return kCoarseCost * cost + kFurtherCost * residual_variance(problem, cost);
  };
  for (const Approach& each : approaches) {
    if (evaluator.budget().spent()) break;
    if (found.best > 1 || each.cost >= least - margin(least)) {
      if (each.cost <= least + margin(least)) ++looks.as_low;
      continue;
    }
    const int number = static_cast<int>(found.starts.size()) + 1;
    ++looks.followed;
    StartReport report;
    report.number = number;
    report.start_values = problem.to_physical(points[each.start]);
    evaluator.set_fidelity(problem.of_starts());
    const Evaluation& first = evaluator.evaluate(points[each.start]);
    report.initial_cost = first.ok ? first.cost : StartReport::kNone;
    evaluator.begin_start(number);
    evaluator.set_fidelity(Fidelity::full);
    SolveResult solved = Search(problem, evaluator, options, number).polish(each.end);
    const Evaluation end = evaluator.best();
    report_end(problem, solved, end, report);
    found.starts.push_back(std::move(report));
    if (!end.ok) continue;
    const double before = found.optimum.cost;
    if (end.cost < before - margin(before)) {
      found.best = number;
      found.optimum = end;
      found.result = std::move(solved);
      least = coarse_cost(end.z);
    } else if (end.cost <= before + margin(before)) {
      ++looks.as_low;
    }
  }
}

}  // namespace

std::vector<std::vector<double>> latin_hypercube(std::size_t points, std::size_t dimensions,
                                                 std::uint64_t seed) {
  boost::random::mt19937_64 random(seed);
  std::vector<std::vector<double>> result(points, std::vector<double>(dimensions));
  std::vector<std::size_t> stratum(points);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(stratum.begin(), stratum.end(), std::size_t{0});
    for (std::size_t i = points; i > 1; --i) {
      const auto other = static_cast<std::size_t>(uniform(random) * static_cast<double>(i));
      std::swap(stratum[i - 1], stratum[other]);
    }
    for (std::size_t i = 0; i < points; ++i) {
      result[i][d] =
          (static_cast<double>(stratum[i]) + uniform(random)) / static_cast<double>(points);
    }
  }
  return result;
}

MultiStart multi_start(const Problem& problem, Evaluator& evaluator, const FitOptions& options) {
  MultiStart result;
  if (options.resume != nullptr) result = resumed(problem, evaluator, options);
  const auto points = start_points(problem, options.starts, options.seed);
  // With a limit on evaluations, the starts must run one after the other.
  const bool in_farm = options.farm != nullptr && options.farm->processes() > 1 &&
                       points.size() > 1 && !options.max_evaluations;
  if (in_farm) {
    make_in_farm(problem, evaluator, options, points, *options.farm, result);
  } else {
    make_in_turn(problem, evaluator, options, points, result);
  }
  if (options.starts == 1 && options.further_starts > 0 && options.resume == nullptr &&
      result.result.status == FitStatus::converged) {
    look_around(problem, evaluator, options, result);
  }
  evaluator.set_fidelity(Fidelity::full);  // needed if the last start failed or none was left
  return result;
}

bool search_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
               MultiStart& found) {
  evaluator.forget();
  found.optimum.rows.reset();
  Search search(problem, evaluator, options, found.best, found.result.iterations);
  found.result = search.polish(found.optimum.z);
  if (!evaluator.best().ok) return false;
  found.optimum = evaluator.best();
  return true;
}

void go_on_with_best(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                     MultiStart& found) {
  const bool unfinished = found.optimum.ok && found.result.status != FitStatus::converged;
  if (!unfinished || found.starts.size() < 2 || evaluator.budget().spent()) return;
  if (search_on(problem, evaluator, options, found)) report_best(problem, found);
}

void report_best(const Problem& problem, MultiStart& found) {
  report_end(problem, found.result, found.optimum,
             found.starts[static_cast<std::size_t>(found.best) - 1]);
}

}  // namespace rigcal::calib
