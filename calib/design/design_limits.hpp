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
  std::string words;  ///< description such as "lowest position"
  std::string unit;   ///< SI unit of `limit` and `reached`
  double limit = 0.0;
  double reached = 0.0;
  Location where;
  /// Used fraction of the allowed range, which for positions begins at the position of the first
  /// sample. At most 1 if the limit is kept.
  double share = 0.0;
};

/// Returns the outputs for which there can be limits, in the order of their columns in a run.
std::span<const model::Output> limited_outputs();

/// Returns how much of each specified limit a run uses. The columns of the run are
/// limited_outputs().
///
/// @param drive  the reference of a position loop, which must also stay within the stroke; empty
///               for other drives
std::vector<LimitUse> limit_uses(const datasets::DesignSettings& settings,
                                 const Eigen::MatrixXd& run, std::span<const double> drive);

/// Returns the largest fraction of any limit that is used.
double largest_share(const std::vector<LimitUse>& uses);

}  // namespace rigcal::calib
