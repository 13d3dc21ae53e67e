#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "datasets/synthetic/noise.hpp"

namespace rigcal::calib {

/// The best of the points that were tried.
struct Evolved {
  Eigen::VectorXd point;  ///< in the unit box; empty: none had a score
  double score = -std::numeric_limits<double>::infinity();
  int evaluations = 0;
};

/// Scores of several points, in their order; minus infinity where there is none. They may be
/// computed side by side.
using ScorePoints = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>&)>;

/// Looks for the largest score in the unit box: a third of the evaluations at random, the others by
/// an evolution strategy with covariance adaptation from the best of these (Hansen, The CMA
/// evolution strategy: a tutorial, arXiv:1604.00772). A coordinate that leaves the box is reflected
/// into it. Needs no derivative of the score, and no score of every point.
///
/// @param evaluations  none are made beyond them
/// @param stopped      asked before each generation; ends the search
Evolved maximise_in_box(Eigen::Index dimensions, int evaluations, datasets::RandomStream& stream,
                        const ScorePoints& scores, const std::function<bool()>& stopped);

}  // namespace rigcal::calib
