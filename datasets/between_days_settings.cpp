#include "datasets/between_days_settings.hpp"

namespace rigcal::datasets {

std::vector<DayQuantityName> day_quantity_names(model::PlantKind plant) {
  std::vector<DayQuantityName> names;
  for (const char* key : {"supply_pressure", "bulk_modulus", "position_offset"}) {
    const int index = model::parameter_index(plant, key);
    if (index < 0) continue;
    const auto& spec = model::parameter_table(plant)[static_cast<std::size_t>(index)];
    names.push_back({key, std::string(spec.unit)});
  }
  names.push_back({kTriggerKey, "s"});
  return names;
}

}  // namespace rigcal::datasets
