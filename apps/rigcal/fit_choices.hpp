#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "report/run/fit_choices.hpp"

namespace rigcal::app {

/// What can be asked of a fit beside its campaign; `batch` asks it of every rig.
struct FitChoices : report::FitChoices {
  bool strict = false;
};

void add_fit_choices(CLI::App& verb, FitChoices& choices);

/// The same as a command line takes them; what nobody asked for is left out.
std::vector<std::string> arguments_of(const FitChoices& choices);

}  // namespace rigcal::app
