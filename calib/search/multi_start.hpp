#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calib/search/search.hpp"

namespace rigcal::calib {

/// Latin hypercube: every dimension is cut into `points` strata, and each stratum has one point.
/// Portable: the same seed gives the same bits on any machine.
///
/// @return  `points` vectors of shape (dimensions), in [0, 1)
std::vector<std::vector<double>> latin_hypercube(std::size_t points, std::size_t dimensions,
                                                 std::uint64_t seed);

/// All starts of a fit and the best of them.
struct MultiStart {
  std::vector<StartReport> starts;
  int best = 0;  ///< number of the best start, from 1; 0 if none has a point that can be simulated
  SolveResult result;                           ///< result of the best start
  Evaluation optimum;                           ///< its end point; not ok if there is none
  std::optional<FurtherStarts> further_starts;  ///< absent if no further starts were evaluated
};

/// Solves from the campaign's start values (start 1) and from a latin hypercube over the unit box;
/// nuisance parameters always start at their own start values. A start that fails leaves the others
/// alone. The best start has the lowest cost, whatever ended it; at equal cost (same_cost()) a
/// converged one is better; ties go to the lower number.
///
/// After a single start that converges, the `further_starts` of the options are evaluated with
/// coarse simulations, and searched to the end only if they lead lower.
MultiStart multi_start(const Problem& problem, Evaluator& evaluator, const FitOptions& options);

/// Polishes the optimum again, where weights or tolerance have changed since.
///
/// @return  false where it cannot be simulated any more
bool search_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
               MultiStart& found);

/// If the best of several starts has not converged, runs another round of iterations from its end.
void go_on_with_best(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
                     MultiStart& found);

/// Enters the end of the best start into its report.
void report_best(const Problem& problem, MultiStart& found);

}  // namespace rigcal::calib
