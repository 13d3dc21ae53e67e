#pragma once

#include <optional>

#include "apps/rigcal/options.hpp"
#include "common/error.hpp"
#include "report/store/result.hpp"

namespace rigcal::app {

/// Exit code of a fit or validation: failed, stopped, or by its verdict.
///
/// @param strict  WARN counts as FAIL
ExitCode exit_code_of(calib::FitStatus status, std::optional<calib::Verdict> verdict, bool strict);

/// Writes the files of a fit or validation into the held folder of --out, and prints scorecard,
/// parameters and verdict.
///
/// @throws WriteError
ExitCode write_and_print(report::HeldFolder& held, const CampaignOptions& options,
                         const report::Result& result, bool strict);

/// --strict
void add_strict_option(CLI::App& verb, bool& strict);

}  // namespace rigcal::app
