#pragma once

#include <CLI/CLI.hpp>

#include "report/run/fit_choices.hpp"

namespace rigcal::app {

/// Options of a fit in addition to its campaign; `batch` passes them to every rig.
struct FitChoices : report::FitChoices {
  bool strict = false;
};

void add_fit_choices(CLI::App& verb, FitChoices& choices);

}  // namespace rigcal::app
