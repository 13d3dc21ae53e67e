#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

// Samples a density with the no-U-turn sampler (Hoffman and Gelman, Journal of Machine Learning
// Research 15, 2014) with multinomial weights and the generalised momentum criterion (Betancourt,
// arXiv:1701.02434). Nothing here depends on rigs.

namespace rigcal::calib {

/// Logarithm of a density at a point, up to a constant, and its gradient.
struct LogDensity {
  /// Minus infinity if the density is zero.
  double value = -std::numeric_limits<double>::infinity();
  Eigen::VectorXd gradient;  ///< ignored if the density is zero
};

using LogDensityOf = std::function<LogDensity(const Eigen::VectorXd&)>;

/// State of a chain between two draws.
struct ChainState {
  Eigen::VectorXd position;
  Eigen::MatrixXd covariance;  ///< inverse mass matrix
  /// The position in coordinates in which the mass is one. It is stored because recomputing it
  /// would introduce rounding that depends on where a group of draws begins. Empty before the first
  /// draw.
  Eigen::VectorXd whitened;
  double step = 0.0;   ///< step length in coordinates in which the mass is one
  long iteration = 0;  ///< number of draws so far, including the warm-up
};

/// A draw with the data needed for diagnostics.
struct Draw {
  Eigen::VectorXd position;
  double energy = 0.0;      ///< total energy of the trajectory: kinetic energy minus log density
  double acceptance = 0.0;  ///< mean acceptance probability over the trajectory
  int doublings = 0;        ///< number of doublings of the trajectory
  bool diverged = false;  ///< true if the energy error exceeded 1000, that is, if the steps are too
                          ///< long for this density
};

struct NutsOptions {
  std::uint64_t seed = 1;
  int chain = 0;  ///< number of the chain, which selects its random numbers
  double target_acceptance = 0.8;
  int most_doublings = 10;
  std::function<bool()> stop;  ///< called after every draw; returns true to stop; may be empty
};

/// Runs the warm-up of a chain. It adapts the step by dual averaging, and estimates the covariance
/// from the draws in two windows, where the given covariance counts as ten draws.
///
/// @return  false if the warm-up was stopped
bool warm_up(const LogDensityOf& density, int draws, const NutsOptions& options, ChainState& state);

/// Makes draws with a fixed step. Random numbers depend only on seed, chain and iteration, so that
/// consecutive calls give the same draws as a single one.
///
/// @return  the draws; fewer than `count` if sampling was stopped
std::vector<Draw> sample(const LogDensityOf& density, int count, const NutsOptions& options,
                         ChainState& state);

}  // namespace rigcal::calib
