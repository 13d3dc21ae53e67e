#include "datasets/checks/record_warnings.hpp"

#include <fmt/format.h>

#include <map>

namespace rigcal::datasets {

std::string RecordWarning::with_conditions() const {
  if (conditions.size() == 1) return fmt::format("recording of {}: {}", conditions.front(), text);
  return fmt::format("recordings of {} conditions ({}, ...): {}", conditions.size(),
                     conditions.front(), text);
}

std::vector<RecordWarning> gathered_warnings(const std::vector<const Record*>& records) {
  std::vector<RecordWarning> gathered;
  std::map<std::string, std::size_t> places;
  for (const Record* record : records) {
    for (const std::string& text : record->warnings) {
      const auto [place, is_new] = places.emplace(text, gathered.size());
      if (is_new) gathered.push_back({text, {}});
      gathered[place->second].conditions.push_back(record->condition);
    }
  }
  return gathered;
}

}  // namespace rigcal::datasets
