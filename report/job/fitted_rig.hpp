#pragma once

#include <string>
#include <vector>

#include "report/job/leak_table_files.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// The rig of a leak table with values from a fit.
struct FittedRig {
  calib::RigUncertainty uncertainty;
  std::vector<std::string> notes;     ///< origin of the values, in words
  std::vector<std::string> warnings;  ///< doubts about the fit or the campaign
};

/// Overrides the campaign's values and assumptions with the estimates from a fit, and then applies
/// --set.
///
/// @throws InputError  if a parameter has different values for different leak levels or conditions
FittedRig take_fit(LeakTableInput& input, const EarlierFit& earlier,
                   const std::vector<std::string>& set);

/// Lists the values of the campaign's rig that assumptions replace although there is no fit, for
/// example the assumptions that `fit` wrote into fitted.toml. Empty if there are none.
std::vector<std::string> replaced_by_assumptions(const LeakTableInput& input);

}  // namespace rigcal::report
