#include "report/run/campaign_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rigcal::report {

datasets::Campaign load(const CampaignChoice& choice) {
  datasets::Campaign campaign = datasets::load_campaign(choice.campaign, choice.data, choice.root);
  for (const std::string& assignment : choice.set) datasets::set_value(campaign, assignment);
  if (!choice.free.empty()) datasets::set_free(campaign, choice.free);
  if (!choice.set.empty() || !choice.free.empty()) datasets::check_values(campaign);
  return campaign;
}

std::vector<std::pair<std::string, std::string>> recorded(const CampaignChoice& choice) {
  return {{"set", fmt::format("{}", fmt::join(choice.set, ", "))},
          {"free", fmt::format("{}", fmt::join(choice.free, ","))}};
}

}  // namespace rigcal::report
