#pragma once

#include <CLI/CLI.hpp>

#include "report/run/fit_choices.hpp"

namespace rigcal::app {

/// Options for a fit that are not in its campaign. `batch` passes them on for every rig.
struct FitChoices : report::FitChoices {
  bool strict = false;
};

void add_fit_choices(CLI::App& verb, FitChoices& choices);

}  // namespace rigcal::app
