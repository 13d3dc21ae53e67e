#pragma once

#include <vector>

#include "calib/result/search_report.hpp"
#include "calib/search/evaluator.hpp"

namespace rigcal::calib {

/// State of a multi-start between two starts. It contains everything needed to continue as if the
/// search had never been stopped.
struct Checkpoint {
  std::vector<StartReport> starts;  ///< completed starts
  int best = 0;                     ///< number of the best start; 0 if none could be simulated
  std::vector<double> best_z;       ///< end point of the best start, in the unit box
  EvaluationCounters counters;      ///< counts of all evaluations so far
};

}  // namespace rigcal::calib
