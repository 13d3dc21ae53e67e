#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calib/search/fit_options.hpp"
#include "datasets/record.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

inline constexpr int kMostThreads = 1024;
inline constexpr int kMostStarts = 100'000;
inline constexpr int kMostReplicates = 1'000'000;

/// What can be asked of a fit beside its campaign.
struct FitChoices {
  std::optional<int> starts;
  std::uint64_t seed = 1;
  int bootstrap = 0;
  bool profiles = false;
  bool cross_validate = false;
  std::optional<double> max_time_s;
  std::optional<long> max_evaluations;
};

/// What the campaign says of a fit.
///
/// @param cancel  ends it; borrowed
calib::FitOptions fit_options(const datasets::Campaign& campaign, int threads,
                              const std::atomic<bool>& cancel);

/// Enters the choices over those of the campaign.
void apply(const FitChoices& choices, calib::FitOptions& settings);

/// What a fit is made from.
///
/// @param settings  with the choices applied
/// @return  of what its starts rest on; those of a result have recorded(choices) at their end
Provenance provenance_of_starts(const std::string& command, const CampaignChoice& choice,
                                const FitChoices& choices, const calib::FitOptions& settings,
                                const datasets::Campaign& campaign,
                                const std::vector<datasets::Record>& records);

/// Those choices beside the starts that put more into a result.
std::vector<std::pair<std::string, std::string>> recorded(const FitChoices& choices);

}  // namespace rigcal::report
