#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

// Sampling of a density by the no-U-turn sampler (Hoffman and Gelman, Journal of Machine Learning
// Research 15, 2014) with multinomial weights and the criterion of generalised momenta (Betancourt,
// arXiv:1701.02434). It knows nothing of rigs.

namespace rigcal::calib {

/// Logarithm of a density at a point, up to a constant, and its gradient.
struct LogDensity {
  double value = -std::numeric_limits<double>::infinity();  ///< minus infinity: no density there
  Eigen::VectorXd gradient;                                 ///< not looked at without a density
};

using LogDensityOf = std::function<LogDensity(const Eigen::VectorXd&)>;

/// State of a chain between two draws.
struct ChainState {
  Eigen::VectorXd position;
  Eigen::MatrixXd covariance;  ///< inverse mass matrix
  /// The position in coordinates in which that is one. It is kept, since to compute it again would
  /// round differently, depending on where a stretch of draws begins; empty before the first draw.
  Eigen::VectorXd whitened;
  double step = 0.0;   ///< in units of that covariance
  long iteration = 0;  ///< draws so far, those of the warm-up included
};

/// A draw with what diagnostics need of it.
struct Draw {
  Eigen::VectorXd position;
  double energy = 0.0;      ///< total energy of its trajectory: minus log density plus kinetic
  double acceptance = 0.0;  ///< mean probability of acceptance over the trajectory
  int doublings = 0;        ///< number that its trajectory took
  bool diverged = false;    ///< the energy error exceeded 1000: steps are too long for the density
};

struct NutsOptions {
  std::uint64_t seed = 1;
  int chain = 0;  ///< number of the chain, for its random numbers
  double target_acceptance = 0.8;
  int most_doublings = 10;
  std::function<bool()> stop;  ///< asked after every draw; may be empty
};

/// Runs the warm-up of a chain: dual averaging of the step, and a covariance from the draws of two
/// windows, of which the given one counts as ten draws.
///
/// @return  false: stopped
bool warm_up(const LogDensityOf& density, int draws, const NutsOptions& options, ChainState& state);

/// Draws with a fixed step. Random numbers depend only on seed, chain and iteration, so that
/// stretches one after the other give the draws of a single run.
///
/// @return  less than `count` if it was stopped
std::vector<Draw> sample(const LogDensityOf& density, int count, const NutsOptions& options,
                         ChainState& state);

}  // namespace rigcal::calib
