#pragma once

#include <Eigen/Core>

#include "calib/posterior/density.hpp"
#include "datasets/synthetic/noise.hpp"

namespace rigcal::calib {

/// Draws from N(mean, sd^2), truncated to values of at least zero.
double positive_normal(datasets::RandomStream& stream, double mean, double sd);

/// Changes the sizes of the effects by sweeps of Gibbs' sampler over their distribution at constant
/// q. A sweep goes through all effects and back, so that it is reversible.
void sweep_sizes(const SizesBeside& sizes, int sweeps, datasets::RandomStream& stream,
                 Eigen::VectorXd& e);

struct SizeStep {
  bool accepted = false;
  int simulated = 0;  ///< number of points that were simulated
};

/// Makes one step of Metropolis and Hastings for the sizes of the effects. It proposes the sizes
/// after some sweeps, and moves the unknowns to make room for them. The sweeps
/// neglect only what is not linear, so most proposals are accepted. A proposal beyond a bound is
/// refused without a simulation.
///
/// @param y  unknowns, which move with the sizes
/// @param e  sizes
SizeStep step_sizes(const PosteriorDensity& density, int sweeps, datasets::RandomStream& stream,
                    Eigen::VectorXd& y, Eigen::VectorXd& e);

}  // namespace rigcal::calib
