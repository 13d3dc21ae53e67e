#pragma once

#include <filesystem>

#include "apps/rigcal/options.hpp"
#include "common/error.hpp"
#include "report/result.hpp"

namespace rigcal::app {

/// Exit code of a fit or validation: failed, stopped, or by its verdict.
ExitCode exit_code_of(const calib::Fit& fit);

/// Writes the files of a fit or validation into --out and prints scorecard, parameters and verdict.
///
/// @throws WriteError
ExitCode write_and_print(const CampaignOptions& options, const report::Result& result);

/// Options of the solver from the campaign and the command line.
calib::FitOptions fit_options(const CampaignOptions& options, const datasets::Campaign& campaign,
                              const std::atomic<bool>& cancel);

}  // namespace rigcal::app
