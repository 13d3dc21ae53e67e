#pragma once

#include <string>
#include <vector>

#include "report/job/leak_table_files.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// The rig of a leak table as a fit found it.
struct FittedRig {
  calib::RigUncertainty uncertainty;
  std::vector<std::string> notes;     ///< origin of the values, in words
  std::vector<std::string> warnings;  ///< doubts about the fit or the campaign
};

/// Puts the estimates of a fit over the campaign's values and assumptions, and --set over both.
///
/// @throws InputError  a value has no single one for the rig
FittedRig take_fit(LeakTableInput& input, const EarlierFit& earlier,
                   const std::vector<std::string>& set);

/// Values of the campaign's rig that assumptions replace without a fit, such as those that `fit`
/// wrote into its fitted.toml; empty if there are none.
std::vector<std::string> replaced_by_assumptions(const LeakTableInput& input);

}  // namespace rigcal::report
