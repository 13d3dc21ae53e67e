#include "apps/rigcal/fit_choices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"

namespace rigcal::app {
namespace {

using report::kMostReplicates;
using report::kMostStarts;

/// Accepts finite positive numbers. CLI11's own check also accepts "nan" and "inf".
CLI::Validator finite_positive() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const bool valid =
            CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
        return valid ? std::string() : fmt::format("found {}, expected a number above zero", text);
      },
      "POSITIVE");
}

}  // namespace

void add_fit_choices(CLI::App& verb, FitChoices& choices) {
  verb.add_option("--starts", choices.starts,
                  "Number of starts (default: the campaign's, or 1, and 3 more if that does not "
                  "reach a minimum); the best result is taken")
      ->check(CLI::Range(1, kMostStarts));
  verb.add_option("--seed", choices.seed, "Seed of the further starts")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
  verb.add_option("--bootstrap", choices.bootstrap,
                  "Bootstrap intervals from this many fits to resampled repeats or residuals")
      ->check(CLI::Range(0, kMostReplicates));
  verb.add_flag("--profiles", choices.profiles, "Profile likelihood of every parameter");
  verb.add_option("--posterior", choices.posterior,
                  "Posterior draws in each of four chains (default: the campaign's, or none; 1000 "
                  "if no number follows)")
      ->expected(0, 1)
      ->default_str("1000")
      ->check(whole_number(datasets::kLeastPosteriorDraws, datasets::kMostPosteriorDraws));
  verb.add_flag("--cross-validate", choices.cross_validate,
                "Cross-validate: leave out each condition in turn and predict it");
  verb.add_option("--max-time", choices.max_time_s,
                  "Stop after this many seconds, bootstrap etc. included (default: the campaign's, "
                  "or none)")
      ->check(finite_positive());
  verb.add_option("--max-evaluations", choices.max_evaluations,
                  "Stop after this many evaluations of all conditions")
      ->check(whole_number(1, std::numeric_limits<long>::max()));
  add_strict_option(verb, choices.strict);
}

}  // namespace rigcal::app
