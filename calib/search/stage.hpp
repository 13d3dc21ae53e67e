#pragma once

#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// One stage of a search: its fidelity and its limits.
struct Stage {
  Fidelity fidelity = Fidelity::full;
  double trust_radius = 0.0;  ///< radius of its first step
  int most_iterations = 0;    ///< limit for this stage; 0: all remaining iterations of the search

  bool is_horizon() const { return !fidelity.whole(); }
};

/// Initial trust radius from a poor start. Ceres' default of 1e4 is effectively unlimited, so that
/// the first step may end in a corner of the bounds and remain there.
inline constexpr double kFirstTrustRadius = 10.0;
/// Initial trust radius close to the optimum, where the full step is the right one.
inline constexpr double kNearTrustRadius = 1e8;

/// Whole records, simulated coarsely, from wherever the search is.
inline constexpr Stage kCoarseStage{Fidelity::coarse, kFirstTrustRadius};
/// Whole records at the working tolerance, from a point close to the optimum.
inline constexpr Stage kPolishStage{Fidelity::full, kNearTrustRadius};

/// Returns the lengths of the growing horizon, each a few times the one before: from a few of the
/// shortest sample intervals up to the longest first period.
std::vector<double> horizons_s(const Problem& problem);

/// Returns the stages of a start: the growing horizon if records are longer than a period of their
/// drive, whole records with coarse simulations, and finally the polish.
///
/// An oscillation is fitted before it completes a cycle, so that phase errors cannot alias. If
/// whole records were fitted at once, a frequency that is off by more than a cycle in the record
/// would lead into a valley of slow valves and stiff oil. Later periods, which repeat the first,
/// are also not worth their simulation time yet.
std::vector<Stage> plan_schedule(const Problem& problem);

}  // namespace rigcal::calib
