#include "model/plant/parameter.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "model/plant/parameter_values.hpp"
#include "model/plant/two_chamber_parameters.hpp"

namespace rigcal::model {
namespace {

template <typename Fields>
constexpr auto table_of(const Fields& fields) {
  std::array<ParameterSpec, std::tuple_size_v<Fields>> table{};
  for (std::size_t i = 0; i < fields.size(); ++i) table[i] = fields[i].spec;
  return table;
}
constexpr auto kLoadPressureTable = table_of(kLoadPressureFields<double>);
constexpr auto kTwoChamberTable = table_of(kTwoChamberFields<double>);

/// One row per plant, in the order of PlantKind.
struct PlantRow {
  PlantKind plant;
  std::string_view name;
  std::span<const ParameterSpec> parameters;
};
constexpr std::array kPlants{
    PlantRow{PlantKind::load_pressure, "load_pressure", kLoadPressureTable},
    PlantRow{PlantKind::two_chamber, "two_chamber", kTwoChamberTable},
};
static_assert(kPlants.size() == kPlantCount, "every plant has a row");
static_assert(std::all_of(kPlants.begin(), kPlants.end(), [](const PlantRow& row) {
  return &row - kPlants.data() == static_cast<std::ptrdiff_t>(row.plant);
}));

const PlantRow& row_of(PlantKind plant) { return kPlants[static_cast<std::size_t>(plant)]; }

int checked_index(PlantKind plant, std::string_view key) {
  const int index = parameter_index(plant, key);
  if (index < 0) throw std::invalid_argument("unknown parameter '" + std::string(key) + "'");
  return index;
}

}  // namespace

std::string_view to_string(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::plant:
      return "plant";
    case ParameterKind::term:
      return "optional term";
    case ParameterKind::controller:
      return "controller";
    case ParameterKind::sensor:
      return "sensor";
    case ParameterKind::initial:
      return "initial state";
  }
  return "";
}

std::optional<PlantKind> plant_from_name(std::string_view name) {
  for (const PlantRow& row : kPlants) {
    if (row.name == name) return row.plant;
  }
  return std::nullopt;
}

std::string_view to_string(PlantKind plant) { return row_of(plant).name; }

std::vector<std::string> plant_names() {
  std::vector<std::string> names;
  for (const PlantRow& row : kPlants) names.emplace_back(row.name);
  return names;
}

std::span<const ParameterSpec> parameter_table(PlantKind plant) { return row_of(plant).parameters; }

int parameter_index(PlantKind plant, std::string_view key) {
  const auto table = parameter_table(plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].key == key) return static_cast<int>(i);
  }
  return -1;
}

ParameterValues ParameterValues::defaults(PlantKind plant) {
  ParameterValues values;
  values.plant = plant;
  for (const ParameterSpec& spec : parameter_table(plant)) {
    values.value.push_back(spec.default_value.value_or(0.0));
    values.given.push_back(false);
  }
  return values;
}

double ParameterValues::operator[](std::string_view key) const {
  return value[static_cast<std::size_t>(checked_index(plant, key))];
}

bool ParameterValues::is_given(std::string_view key) const {
  return given[static_cast<std::size_t>(checked_index(plant, key))];
}

void ParameterValues::set(std::string_view key, double value_si) {
  set(checked_index(plant, key), value_si);
}

void ParameterValues::set(int index, double value_si) {
  value.at(static_cast<std::size_t>(index)) = value_si;
  given.at(static_cast<std::size_t>(index)) = true;
}

std::vector<std::string> ParameterValues::missing() const {
  std::vector<std::string> keys;
  const auto table = parameter_table(plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].kind == ParameterKind::plant && !table[i].default_value && !given[i]) {
      keys.emplace_back(table[i].key);
    }
  }
  return keys;
}

}  // namespace rigcal::model
