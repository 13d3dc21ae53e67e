#pragma once

#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// One stage of a search: its fidelity and its limits.
struct Stage {
  Fidelity fidelity = Fidelity::full;
  double trust_radius = 0.0;  ///< radius of its first step
  int most_iterations = 0;    ///< limit for this stage; 0: no limit other than that of the search

  bool is_horizon() const { return !fidelity.whole(); }
};

/// Initial trust radius from a poor start. Ceres' default of 1e4 is effectively unlimited: the
/// first step might end in a corner of the box, and the search would not get out of it.
inline constexpr double kFirstTrustRadius = 10.0;
/// Initial trust radius close to the optimum, where the full step is the right one.
inline constexpr double kNearTrustRadius = 1e8;

/// Whole records, simulated coarsely, starting at any distance from the optimum.
inline constexpr Stage kCoarseStage{Fidelity::coarse, kFirstTrustRadius};
/// Whole records at the working tolerance, from a point close to the optimum.
inline constexpr Stage kPolishStage{Fidelity::full, kNearTrustRadius};

/// Returns the lengths of the growing horizon, from a few of the shortest sampling intervals up to
/// the longest first period. Each is a few times as long as the one before.
std::vector<double> horizons_s(const Problem& problem);

/// Returns the stages of a start: growing horizons if records are longer than one period of their
/// drive, then whole records with coarse simulations, and finally whole records at the working
/// tolerance.
///
/// With a short horizon, an oscillation is fitted before it completes a cycle, so that phase errors
/// cannot alias. If whole records were fitted immediately, a frequency that is off by more than a
/// cycle over the record would lead the search into a valley of slow valves and stiff oil. In
/// addition, later periods only repeat the first and are not yet worth simulating.
std::vector<Stage> plan_schedule(const Problem& problem);

}  // namespace rigcal::calib
