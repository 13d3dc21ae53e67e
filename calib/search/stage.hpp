#pragma once

#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// One stage of a search: its fidelity and its limits.
struct Stage {
  Fidelity fidelity = Fidelity::full;
  double trust_radius = 0.0;  ///< radius of its first step
  int most_iterations = 0;    ///< limit for this stage; 0: all that the search has left

  bool is_horizon() const { return !fidelity.whole(); }
};

/// Ceres' default of 1e4 is effectively unlimited: from a poor start the first step may end in a
/// corner of the bounds and stay there.
inline constexpr double kFirstTrustRadius = 10.0;
/// Near the optimum the full step is the right one.
inline constexpr double kNearTrustRadius = 1e8;

/// Whole records, coarsely simulated, from wherever the search is.
inline constexpr Stage kCoarseStage{Fidelity::coarse, kFirstTrustRadius};
/// Whole records at the working tolerance, from near the optimum.
inline constexpr Stage kPolishStage{Fidelity::full, kNearTrustRadius};

/// Lengths of the growing horizon, each a few times the one before it: from a few of the shortest
/// sample intervals up to the longest first period.
std::vector<double> horizons_s(const Problem& problem);

/// The stages of a start: the growing horizon where records are longer than a period of their
/// drive, whole records coarsely, then the polish.
///
/// An oscillation is fitted before it completes a cycle, so that phase errors cannot alias: fitted
/// at once, a frequency that is off by more than a cycle in the record leads into a valley of slow
/// valves and stiff oil. Nor are later periods, which repeat the first, worth their time yet.
std::vector<Stage> plan_schedule(const Problem& problem);

}  // namespace rigcal::calib
