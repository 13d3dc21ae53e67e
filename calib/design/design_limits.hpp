#pragma once

#include <span>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {

/// One limit in [design], and how much of it a drive uses.
struct LimitUse {
  std::string key;    ///< key in the campaign file: "stroke"
  std::string words;  ///< for example "lowest position"
  std::string unit;   ///< in SI
  double limit = 0.0;
  double reached = 0.0;
  Location where;
  /// Used fraction of the allowed range; for positions, the range counts from the position at the
  /// first sample. At most 1 if the limit is kept.
  double share = 0.0;
};

/// Returns the outputs for which there are limits, in the order of their columns in a run.
std::span<const model::Output> limited_outputs();

/// Returns how much of each specified limit a run of limited_outputs() uses.
///
/// @param drive  reference of a position loop, which must also remain within the stroke; empty for
///               other drives
std::vector<LimitUse> limit_uses(const datasets::DesignSettings& settings,
                                 const Eigen::MatrixXd& run, std::span<const double> drive);

/// Returns the largest used fraction.
double largest_share(const std::vector<LimitUse>& uses);

}  // namespace rigcal::calib
