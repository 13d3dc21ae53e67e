#pragma once

#include <span>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {

/// One limit of [design], and what a drive makes of it.
struct LimitUse {
  std::string key;    ///< in the campaign file: "stroke"
  std::string words;  ///< "lowest position"
  std::string unit;   ///< SI
  double limit = 0.0;
  double reached = 0.0;
  Location where;
  /// Used part of what is allowed, counted from the state at the first sample for positions; at
  /// most 1 where the limit is kept.
  double share = 0.0;
};

/// Outputs that limits are about; their columns in the runs below.
std::span<const model::Output> limited_outputs();

/// What a run of limited_outputs() makes of each limit that is stated.
///
/// @param drive  reference of a position loop, which has to stay within the stroke as well; empty
///               for other drives
std::vector<LimitUse> limit_uses(const datasets::DesignSettings& settings,
                                 const Eigen::MatrixXd& run, std::span<const double> drive);

/// The largest share.
double largest_share(const std::vector<LimitUse>& uses);

}  // namespace rigcal::calib
