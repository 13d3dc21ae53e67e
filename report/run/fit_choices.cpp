#include "report/run/fit_choices.hpp"

#include <fmt/format.h>

namespace rigcal::report {
namespace {

/// Number of further starts if the campaign's start does not end at a minimum and no number is
/// given.
constexpr int kFurtherStarts = 3;

}  // namespace

calib::FitOptions fit_options(const datasets::Campaign& campaign, int threads,
                              const std::atomic<bool>& cancel) {
  calib::FitOptions fit;
  fit.starts = campaign.fit.starts;
  fit.max_iterations = campaign.fit.max_iterations;
  fit.posterior = campaign.fit.posterior;
  fit.max_seconds = campaign.fit.max_seconds;
  fit.threads = threads;
  fit.cancel = &cancel;
  return fit;
}

void apply(const FitChoices& choices, calib::FitOptions& settings) {
  settings.starts = choices.starts.value_or(settings.starts);
  if (!choices.starts) settings.further_starts = kFurtherStarts;
  settings.seed = choices.seed;
  settings.bootstrap = choices.bootstrap;
  settings.profiles = choices.profiles;
  settings.posterior = choices.posterior.value_or(settings.posterior);
  settings.cross_validate = choices.cross_validate;
  settings.max_evaluations = choices.max_evaluations;
  if (choices.max_time_s) settings.max_seconds = choices.max_time_s;
}

Provenance provenance_of_starts(const std::string& command,
                                std::vector<std::pair<std::string, std::string>> options,
                                const FitChoices& choices, const calib::FitOptions& settings,
                                const datasets::Campaign& campaign,
                                const std::vector<datasets::Record>& records) {
  Provenance provenance{command, choices.seed, std::move(options), hash_inputs(campaign, records)};
  provenance.options.emplace_back("starts", fmt::format("{}", settings.starts));
  return provenance;
}

std::vector<std::pair<std::string, std::string>> recorded(const FitChoices& choices) {
  std::vector<std::pair<std::string, std::string>> options;
  if (choices.bootstrap > 0)
    options.emplace_back("bootstrap", fmt::format("{}", choices.bootstrap));
  if (choices.profiles) options.emplace_back("profiles", "true");
  if (choices.posterior) options.emplace_back("posterior", fmt::format("{}", *choices.posterior));
  if (choices.cross_validate) options.emplace_back("cross_validate", "true");
  return options;
}

std::vector<std::string> arguments_of(const FitChoices& choices) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    arguments.emplace_back(option);
    arguments.push_back(value);
  };
  if (choices.starts) add("--starts", fmt::format("{}", *choices.starts));
  if (choices.seed != FitChoices{}.seed) add("--seed", fmt::format("{}", choices.seed));
  if (choices.bootstrap > 0) add("--bootstrap", fmt::format("{}", choices.bootstrap));
  if (choices.profiles) arguments.emplace_back("--profiles");
  if (choices.posterior) add("--posterior", fmt::format("{}", *choices.posterior));
  if (choices.cross_validate) arguments.emplace_back("--cross-validate");
  if (choices.max_time_s) add("--max-time", fmt::format("{}", *choices.max_time_s));
  if (choices.max_evaluations)
    add("--max-evaluations", fmt::format("{}", *choices.max_evaluations));
  return arguments;
}

}  // namespace rigcal::report
