#include "model/fmi/equations.hpp"
#include "model/plant/plants.hpp"

namespace rigcal::model {

std::vector<StateDescription> describe_states(const ExportedRig& rig, const Layout& layout) {
  std::vector<StateDescription> states;
  const auto add = [&](const StateRow& row) {
    const double unit = row.unit == "Pa" ? rig.values["supply_pressure"] : 1.0;
    states.push_back({std::string(row.name), std::string(row.unit), std::string(row.meaning),
                      row.nominal * unit});
  };
  const auto add_plant = [&]<typename Plant>() {
    for (const StateRow& row : Plant::kStateRows) add(row);
  };
  switch (rig.rig.plant) {
    case PlantKind::load_pressure:
      add_plant.operator()<LoadPressurePlant>();
      break;
    case PlantKind::two_chamber:
      add_plant.operator()<TwoChamberPlant>();
      break;
    case PlantKind::linkage:
      add_plant.operator()<LinkagePlant>();
      break;
  }
  for (int i = layout.plant_states; i < layout.states; ++i)
    add(*layout.added.at(static_cast<std::size_t>(i - layout.plant_states)));
  return states;
}

}  // namespace rigcal::model
