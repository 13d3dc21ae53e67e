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

/// Options of a fit in addition to its campaign.
struct FitChoices {
  std::optional<int> starts;
  std::uint64_t seed = 1;
  int bootstrap = 0;
  bool profiles = false;
  std::optional<int> posterior;  ///< draws of each chain
  bool cross_validate = false;
  std::optional<double> max_time_s;
  std::optional<long> max_evaluations;
};

/// Options of a fit from its campaign.
///
/// @param cancel  ends it; borrowed
calib::FitOptions fit_options(const datasets::Campaign& campaign, int threads,
                              const std::atomic<bool>& cancel);

/// Enters the choices over those of the campaign.
void apply(const FitChoices& choices, calib::FitOptions& settings);

/// Provenance of a fit.
///
/// @param options   recorded() of the campaign's choice
/// @param settings  with the choices applied
/// @return  for the starts; that of a result has recorded(choices) at its end
Provenance provenance_of_starts(const std::string& command,
                                std::vector<std::pair<std::string, std::string>> options,
                                const FitChoices& choices, const calib::FitOptions& settings,
                                const datasets::Campaign& campaign,
                                const std::vector<datasets::Record>& records);

/// The choices as arguments of a command line, without defaults.
std::vector<std::string> arguments_of(const FitChoices& choices);

/// The choices that add to a result without changing its starts.
std::vector<std::pair<std::string, std::string>> recorded(const FitChoices& choices);

}  // namespace rigcal::report
