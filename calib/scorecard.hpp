#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem.hpp"

namespace rigcal::calib {

/// Simulates every condition of a problem at z, over the whole record, and scores it.
///
/// @param z  shape (unknowns), in the unit box
/// @return   in the order of the problem's conditions; a condition that cannot be simulated says
/// why
std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads);

/// Scores that are better than the noise allows any model, in words: the fit follows the noise, or
/// the noise is smaller than its stated standard deviation.
std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores);

/// What scores are gathered by.
enum class GroupBy { waveform, frequency, leak_level };
std::string_view to_string(GroupBy by);

/// Scores of one channel over all conditions that have something in common.
struct ScoreGroup {
  GroupBy by = GroupBy::waveform;
  std::string key;  ///< "sine", "0.1 Hz", "33.33 %"; "-" where the condition has none
  datasets::Channel channel = datasets::Channel::position;
  int count = 0;                        ///< conditions with a score
  std::map<std::string, double> mean;   ///< by metric name
  std::map<std::string, double> worst;  ///< smallest, or largest where lower is better
};

/// Groups in order of first appearance; conditions without a score are left out.
std::vector<ScoreGroup> gather(const datasets::Campaign& campaign,
                               const std::vector<ConditionScore>& scores, GroupBy by);

}  // namespace rigcal::calib
