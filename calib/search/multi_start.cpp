#include "calib/search/multi_start.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <numeric>

#include "calib/search/checkpoint.hpp"
#include "common/error.hpp"

namespace rigcal::calib {
namespace {

/// Uniform in [0, 1) with 53 bits; std::uniform_real_distribution differs between libraries.
double uniform(boost::random::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

std::vector<std::vector<double>> start_points(const Problem& problem, const FitOptions& options) {
  const auto& unknowns = problem.map.unknowns();
  std::vector<std::size_t> spread;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    if (!unknowns[j].nuisance) spread.push_back(j);
  }
  std::vector<std::vector<double>> points{problem.start()};
  const auto others = static_cast<std::size_t>(options.starts - 1);
  for (const auto& sample : latin_hypercube(others, spread.size(), options.seed)) {
    points.push_back(points.front());
    for (std::size_t k = 0; k < spread.size(); ++k) points.back()[spread[k]] = sample[k];
  }
  return points;
}

bool better(const StartReport& a, const StartReport& b) {
  const bool a_converged = a.status == FitStatus::converged;
  const bool b_converged = b.status == FitStatus::converged;
  return a_converged != b_converged ? a_converged : a.final_cost < b.final_cost;
}

/// The state after the starts of a checkpoint; evaluates the best point again.
MultiStart resumed(const Problem& problem, Evaluator& evaluator, const FitOptions& options) {
  const Checkpoint& from = *options.resume;
  MultiStart result;
  result.starts = from.starts;
  result.best = from.best;
  evaluator.set_counters(from.counters);
  if (from.starts.empty()) return result;
  const bool any = from.best > 0;
  const StartReport& report = from.starts[any ? static_cast<std::size_t>(from.best) - 1 : 0];
  result.result.status = report.status;
  result.result.message = report.message;
  result.result.iterations = report.iterations;
  if (!any) return result;
  if (from.best_z.size() == problem.map.unknowns().size())
    result.optimum = evaluate_at(problem, from.best_z, options.threads);
  if (!result.optimum.ok) {
    throw InputError({"checkpoint"},
                     "its best point cannot be simulated: expected one of this fit");
  }
  result.result.check = check_optimum(problem, result.optimum);
  return result;
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
  const auto points = start_points(problem, options);
  for (std::size_t i = result.starts.size(); i < points.size(); ++i) {
    if (i > 0 && evaluator.aborted()) break;
    const int number = static_cast<int>(i) + 1;
    evaluator.begin_start(number);
    evaluator.set_fidelity(problem.of_starts());
    StartReport report;
    report.number = number;
    report.start_values = problem.to_physical(points[i]);
    const Evaluation& first = evaluator.evaluate(points[i]);
    report.initial_cost = first.ok ? first.cost : 0.0;
    const SolveResult solved = Search(problem, evaluator, options, number).run(points[i]);
    report.status = solved.status;
    report.message = solved.message;
    report.iterations = solved.iterations;
    const Evaluation& end = evaluator.best();
    if (end.ok) {
      report.end_values = problem.to_physical(end.z);
      report.final_cost = end.cost;
      const bool first_usable = result.best == 0;
      if (first_usable ||
          better(report, result.starts[static_cast<std::size_t>(result.best) - 1])) {
        result.best = number;
        result.optimum = end;
        result.result = solved;
      }
    } else if (result.best == 0 && i == 0) {
      result.result = solved;
    }
    result.starts.push_back(std::move(report));
    // A start that was cut short is made again.
    if (options.checkpoint && !evaluator.aborted())
      options.checkpoint({result.starts, result.best, result.optimum.z, evaluator.counters()});
  }
  evaluator.set_fidelity(Fidelity::full);  // a last start that failed, or none that was left
  return result;
}

bool search_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
               MultiStart& found) {
  evaluator.forget();
  Search search(problem, evaluator, options, found.best, found.result.iterations);
  found.result = search.polish(found.optimum.z);
  if (!evaluator.best().ok) return false;
  found.optimum = evaluator.best();
  return true;
}

void report_best(const Problem& problem, MultiStart& found) {
  StartReport& report = found.starts[static_cast<std::size_t>(found.best) - 1];
  report.status = found.result.status;
  report.message = found.result.message;
  report.iterations = found.result.iterations;
  report.final_cost = found.optimum.cost;
  report.end_values = problem.to_physical(found.optimum.z);
}

}  // namespace rigcal::calib
