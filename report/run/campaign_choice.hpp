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
  std::filesystem::path data;     ///< base of relative record paths; empty: the file's folder
  std::filesystem::path root;     ///< no file outside this folder is read; empty: no restriction
  std::vector<std::string> set;   ///< name="value unit"
  std::vector<std::string> free;  ///< exactly these are fitted; empty: the campaign's
};

/// The campaign with the values of `set` and `free`.
///
/// @throws InputError, UsageError
datasets::Campaign load(const CampaignChoice& choice);

/// Choices that change numbers, for the provenance.
std::vector<std::pair<std::string, std::string>> recorded(const CampaignChoice& choice);

}  // namespace rigcal::report
