#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::report {

/// Which campaign is worked on, and what was changed in it.
struct CampaignChoice {
  std::filesystem::path campaign;
  std::filesystem::path data;     ///< where relative record paths start; empty: the file's folder
  std::filesystem::path root;     ///< no file outside this folder is read; empty: no restriction
  std::vector<std::string> set;   ///< name="value unit"
  std::vector<std::string> free;  ///< exactly these are fitted; empty: the campaign's
};

/// The campaign with the values of `set` and `free`.
///
/// @throws InputError, UsageError
datasets::Campaign load(const CampaignChoice& choice);

/// What of it changes numbers, for the provenance.
std::vector<std::pair<std::string, std::string>> recorded(const CampaignChoice& choice);

}  // namespace rigcal::report
