#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calib/search/fit_options.hpp"

namespace rigcal::app {

/// What can be asked of a fit beside its campaign; `batch` asks it of every rig.
struct FitChoices {
  std::optional<int> starts;
  std::uint64_t seed = 1;
  int bootstrap = 0;
  bool profiles = false;
  bool cross_validate = false;
  bool strict = false;
  std::optional<double> max_time_s;
  std::optional<long> max_evaluations;
};

void add_fit_choices(CLI::App& verb, FitChoices& choices);

/// The same as a command line takes them; what nobody asked for is left out.
std::vector<std::string> arguments_of(const FitChoices& choices);

/// Enters them over those of the campaign.
void apply(const FitChoices& choices, calib::FitOptions& settings);

/// Those beside the starts that put more into a result: what `provenance.options` names.
std::vector<std::pair<std::string, std::string>> recorded(const FitChoices& choices);

}  // namespace rigcal::app
