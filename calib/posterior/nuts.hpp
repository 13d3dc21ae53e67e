#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

// Samples a density with the no-U-turn sampler (Hoffman and Gelman, Journal of Machine Learning
// Research 15, 2014) with multinomial weights and the generalised momentum criterion (Betancourt,
// arXiv:1701.02434). It is independent of rigs.

namespace rigcal::calib {

/// Logarithm of a density at a point, up to a constant, and its gradient.
struct LogDensity {
  double value = -std::numeric_limits<double>::infinity();  ///< minus infinity: the density is zero
  Eigen::VectorXd gradient;                                 ///< ignored if the density is zero
};

using LogDensityOf = std::function<LogDensity(const Eigen::VectorXd&)>;

/// State of a chain between two draws.
struct ChainState {
  Eigen::VectorXd position;
  Eigen::MatrixXd covariance;  ///< inverse mass matrix
  /// The position in coordinates in which the mass is one. It is stored because computing it again
  /// would round differently, depending on where a group of draws begins. Empty before the first
  /// draw.
  Eigen::VectorXd whitened;
  double step = 0.0;   ///< in units of the covariance
  long iteration = 0;  ///< number of draws so far, including the warm-up
};

/// A draw with the data needed for diagnostics.
struct Draw {
  Eigen::VectorXd position;
  double energy = 0.0;      ///< total energy of its trajectory: minus log density plus kinetic
  double acceptance = 0.0;  ///< mean acceptance probability over the trajectory
  int doublings = 0;        ///< number of doublings in its trajectory
  bool diverged = false;    ///< the energy error exceeded 1000: steps are too long for this density
};

struct NutsOptions {
  std::uint64_t seed = 1;
  int chain = 0;  ///< number of the chain, for its random numbers
  double target_acceptance = 0.8;
  int most_doublings = 10;
  std::function<bool()> stop;  ///< called after every draw; returns true to stop; may be empty
};

/// Runs the warm-up of a chain: dual averaging of the step, and a covariance from the draws of two
/// windows. The given covariance counts as ten draws.
///
/// @return  false if it was stopped
bool warm_up(const LogDensityOf& density, int draws, const NutsOptions& options, ChainState& state);

/// Makes draws with a fixed step. Random numbers depend only on seed, chain and iteration, so that
/// consecutive calls give the same draws as a single one.
///
/// @return  fewer than `count` draws if it was stopped
std::vector<Draw> sample(const LogDensityOf& density, int count, const NutsOptions& options,
                         ChainState& state);

}  // namespace rigcal::calib
