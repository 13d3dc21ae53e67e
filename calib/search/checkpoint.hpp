#pragma once

#include <vector>

#include "calib/result/search_report.hpp"
#include "calib/search/evaluator.hpp"

namespace rigcal::calib {

/// A multi-start between two starts: enough to go on as if it had never been stopped.
struct Checkpoint {
  std::vector<StartReport> starts;  ///< finished ones
  int best = 0;                     ///< number of the best of them; 0: none could be simulated
  std::vector<double> best_z;       ///< its end, in the unit box
  EvaluationCounters counters;      ///< up to there
};

}  // namespace rigcal::calib
