#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/search/fit_options.hpp"
#include "datasets/record.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

inline constexpr int kMostThreads = 1024;
inline constexpr int kMostStarts = 100'000;
inline constexpr int kMostReplicates = 1'000'000;

/// Options for a fit in addition to those in the campaign.
struct FitChoices {
  std::optional<int> starts;
  std::uint64_t seed = 1;
  int bootstrap = 0;
  bool profiles = false;
  std::optional<int> posterior;  ///< number of draws in each chain
  bool cross_validate = false;
  std::optional<double> max_time_s;
  std::optional<long> max_evaluations;
};

/// Returns the fit options that the campaign specifies.
///
/// @param cancel  set to true to stop the fit; borrowed
calib::FitOptions fit_options(const datasets::Campaign& campaign, int threads,
                              const std::atomic<bool>& cancel);

/// Overrides the options from the campaign with the choices.
void apply(const FitChoices& choices, calib::FitOptions& settings);

/// Returns the provenance of the starts. For the provenance of a result, append recorded(choices).
///
/// @param options   recorded() for the choice of campaign
/// @param settings  with the choices applied
Provenance provenance_of_starts(const std::string& command,
                                std::vector<std::pair<std::string, std::string>> options,
                                const FitChoices& choices, const calib::FitOptions& settings,
                                const datasets::Campaign& campaign,
                                const std::vector<datasets::Record>& records);

/// Returns the choices as command-line arguments, without defaults.
std::vector<std::string> arguments_of(const FitChoices& choices);

/// Returns the choices that add to a result but do not change its starts.
std::vector<std::pair<std::string, std::string>> recorded(const FitChoices& choices);

}  // namespace rigcal::report
