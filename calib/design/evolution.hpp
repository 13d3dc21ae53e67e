#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "datasets/synthetic/noise.hpp"

namespace rigcal::calib {

/// The best of all points tried.
struct Evolved {
  Eigen::VectorXd point;  ///< in the unit box; empty if no point had a score
  double score = -std::numeric_limits<double>::infinity();
  int evaluations = 0;
};

/// Returns the scores of several points in the same order; minus infinity if a point has no score.
/// The scores may be computed in parallel.
using ScorePoints = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>&)>;

/// Searches for the largest score in the unit box. A third of the evaluations are spent on random
/// points. An evolution strategy with covariance matrix adaptation then starts from the best of
/// them (Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772). A coordinate that
/// leaves the box is reflected back into it. No derivatives are needed, and the score need not
/// exist at every point.
///
/// @param evaluations  maximum number of evaluations
/// @param stopped      called before each generation; returns true to end the search
Evolved maximise_in_box(Eigen::Index dimensions, int evaluations, datasets::RandomStream& stream,
                        const ScorePoints& scores, const std::function<bool()>& stopped);

}  // namespace rigcal::calib
