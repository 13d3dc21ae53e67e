#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

#include "model/plant/linkage.hpp"
#include "model/plant/load_pressure.hpp"
#include "model/plant/two_chamber.hpp"

namespace rigcal::model {

/// Every plant, in the order of PlantKind. To add a plant, include its header above, append its
/// type here, and add its solvers to model/CMakeLists.txt; campaign files, fits and `rigcal params`
/// follow.
using Plants = std::tuple<LoadPressurePlant, TwoChamberPlant, LinkagePlant>;
inline constexpr std::size_t kPlantCount = std::tuple_size_v<Plants>;

template <PlantKind Kind>
using PlantOf = std::tuple_element_t<static_cast<std::size_t>(Kind), Plants>;
static_assert(std::is_same_v<PlantOf<PlantKind::load_pressure>, LoadPressurePlant>);
static_assert(std::is_same_v<PlantOf<PlantKind::two_chamber>, TwoChamberPlant>);
static_assert(std::is_same_v<PlantOf<PlantKind::linkage>, LinkagePlant>);

}  // namespace rigcal::model
