#include "report/run/campaign_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/error.hpp"
#include "common/suggest.hpp"

namespace rigcal::report {

datasets::Campaign load(const CampaignChoice& choice) {
  datasets::Campaign campaign = datasets::load_campaign(choice.campaign, choice.data, choice.root);
  for (const std::string& assignment : choice.set) datasets::set_value(campaign, assignment);
  if (!choice.free.empty()) datasets::set_free(campaign, choice.free);
  if (!choice.set.empty() || !choice.free.empty()) datasets::check_values(campaign);
  return campaign;
}

const datasets::Condition& chosen_condition(const datasets::Campaign& campaign,
                                            const std::string& id, const std::string& argument) {
  if (const datasets::Condition* condition = campaign.find(id)) return *condition;
  std::vector<std::string> known;
  for (const datasets::Condition& condition : campaign.conditions) known.push_back(condition.id);
  throw UsageError(argument + ": " + unknown_name_message("condition", id, known));
}

std::vector<std::pair<std::string, std::string>> recorded(const CampaignChoice& choice) {
  return {{"set", fmt::format("{}", fmt::join(choice.set, ", "))},
          {"free", fmt::format("{}", fmt::join(choice.free, ","))}};
}

}  // namespace rigcal::report
