#pragma once

#include <map>
#include <utility>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/result/search_report.hpp"

namespace rigcal::calib {

/// Counts the evaluations that a search has made, and those that failed.
struct EvaluationCounters {
  long evaluations = 0;
  long failure_count = 0;
  std::vector<SimulationFailure> failures;  ///< the first few failures for each condition and kind
  std::map<std::pair<std::size_t, model::SimulationStatus>, int> kept;

  void record(const Problem& problem, const Evaluation& evaluation, int start);
  /// Adds the counts of evaluations that were made after those counted here.
  void add(const EvaluationCounters& later, const Problem& problem);
};

}  // namespace rigcal::calib
