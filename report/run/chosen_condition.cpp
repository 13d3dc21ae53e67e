#include "report/run/chosen_condition.hpp"

#include "common/error.hpp"
#include "common/suggest.hpp"

namespace rigcal::report {

const datasets::Condition& chosen_condition(const datasets::Campaign& campaign,
                                            const std::string& id) {
  if (const datasets::Condition* condition = campaign.find(id)) return *condition;
  std::vector<std::string> known;
  for (const datasets::Condition& condition : campaign.conditions) known.push_back(condition.id);
  throw UsageError("--condition: " + unknown_name_message("condition", id, known));
}

}  // namespace rigcal::report
