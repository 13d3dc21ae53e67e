#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::report {

/// The chosen campaign, with changes from the command line.
struct CampaignChoice {
  std::filesystem::path campaign;
  std::filesystem::path data;     ///< base of relative record paths; empty: the campaign's folder
  std::filesystem::path root;     ///< no file outside this folder is read; empty: no restriction
  std::vector<std::string> set;   ///< each as name="value unit"
  std::vector<std::string> free;  ///< the only parameters to fit; empty: those of the campaign
};

/// Loads the campaign and applies `set` and `free`.
///
/// @throws InputError, UsageError  if the campaign, or a change to it, is invalid
datasets::Campaign load(const CampaignChoice& choice);

/// Returns the condition with an id.
///
/// @param argument  name of the id in messages
/// @throws UsageError  if no condition has this id
const datasets::Condition& chosen_condition(const datasets::Campaign& campaign,
                                            const std::string& id,
                                            const std::string& argument = "--condition");

/// Returns the choices that affect the numbers, for the provenance.
std::vector<std::pair<std::string, std::string>> recorded(const CampaignChoice& choice);

}  // namespace rigcal::report
