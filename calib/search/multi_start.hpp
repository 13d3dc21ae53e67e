#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calib/search/search.hpp"

namespace rigcal::calib {

/// Returns a latin hypercube: every dimension is divided into `points` strata, and each stratum
/// contains one point. The same seed gives bitwise identical points on any machine.
///
/// @return  `points` vectors of shape (dimensions), in [0, 1)
std::vector<std::vector<double>> latin_hypercube(std::size_t points, std::size_t dimensions,
                                                 std::uint64_t seed);

/// All starts of a fit, and the best of them.
struct MultiStart {
  std::vector<StartReport> starts;
  int best = 0;        ///< number of the best start, from 1; 0 if none could be simulated
  SolveResult result;  ///< result of the best start
  Evaluation optimum;  ///< end point of the best start; not ok if there is none
  std::optional<FurtherStarts> further_starts;  ///< absent if no further starts were evaluated
};

/// Solves from the campaign's start values (start 1) and from a latin hypercube over the unit box.
/// Nuisance parameters always start at their own start values. A failed start does not affect the
/// others. The best start is the one with the lowest cost, regardless of why it ended. Among starts
/// of equal cost (same_cost()) a converged one is preferred, then the one with the lower number.
///
/// If there is only one start and it converges, `options.further_starts` more starts are evaluated
/// with coarse simulations. Only those that lead to a lower cost are searched fully.
MultiStart multi_start(const Problem& problem, Evaluator& evaluator, const FitOptions& options);

/// Refines the optimum again after weights or tolerance have changed.
///
/// @return  false if the optimum cannot be simulated any more
bool search_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
               MultiStart& found);

/// If the best of several starts has not converged, runs another round of iterations from its end
/// point.
void go_on_with_best(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                     MultiStart& found);

/// Stores the result of the best start in its report.
void report_best(const Problem& problem, MultiStart& found);

}  // namespace rigcal::calib
