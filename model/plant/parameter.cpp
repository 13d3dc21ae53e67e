#include "model/plant/parameter.hpp"

#include <array>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "model/plant/kinds.hpp"
#include "model/plant/plants.hpp"

namespace rigcal::model {
namespace {

template <typename Fields>
constexpr auto table_of(const Fields& fields) {
  std::array<ParameterSpec, std::tuple_size_v<Fields>> table{};
  for (std::size_t i = 0; i < fields.size(); ++i) table[i] = fields[i].spec;
  return table;
}
template <typename Plant>
constexpr auto kTable = table_of(Plant::template fields<double>());

/// Compares the kinds of all quantities of a plant. A row in metres that belongs to an angle does
/// not compile.
template <typename Plant>
constexpr std::span<const ParameterSpec> checked_table() {
  static_assert(are_named_by_units(kTable<Plant>), "a name does not end in the unit of its row");
  static_assert(motion_agrees(Plant::kStateRows), "the second state is not the rate of the first");
  static_assert(sensors_agree(kTable<Plant>, Plant::kStateRows),
                "a sensor has another kind than its quantity");
  static_assert(initial_values_agree(kTable<Plant>, Plant::kStateRows),
                "an initial value has another kind than its state");
  static_assert(gains_agree(kTable<Plant>, Plant::kStateRows),
                "a gain or a filter has another kind than the quantity of its loop");
  return kTable<Plant>;
}

struct PlantRow {
  std::string_view name;
  std::span<const ParameterSpec> parameters;
};
template <typename... Plant>
constexpr std::array<PlantRow, sizeof...(Plant)> rows_of(std::type_identity<std::tuple<Plant...>>) {
  return {PlantRow{Plant::kName, checked_table<Plant>()}...};
}
constexpr auto kPlants = rows_of(std::type_identity<Plants>());

const PlantRow& row_of(PlantKind plant) { return kPlants[static_cast<std::size_t>(plant)]; }

[[noreturn]] void fail_unknown(std::string_view key) {
  throw std::invalid_argument("unknown parameter '" + std::string(key) + "'");
}

int checked_index(PlantKind plant, std::string_view key) {
  const int index = parameter_index(plant, key);
  if (index < 0) fail_unknown(key);
  return index;
}

/// Checks that at least one plant has a parameter with this key.
void check_known(std::string_view key) {
  for (std::size_t i = 0; i < kPlants.size(); ++i) {
    if (parameter_index(static_cast<PlantKind>(i), key) >= 0) return;
  }
  fail_unknown(key);
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

bool is_lag(const ParameterSpec& spec) {
  return spec.key == "valve_time_constant" || spec.key.ends_with("_lag");
}

std::optional<PlantKind> plant_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kPlants.size(); ++i) {
    if (kPlants[i].name == name) return static_cast<PlantKind>(i);
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

const ParameterSpec& parameter_spec(PlantKind plant, int index) {
  const auto table = parameter_table(plant);
  if (index < 0 || static_cast<std::size_t>(index) >= table.size())
    throw std::out_of_range(std::string(to_string(plant)) + ": has no parameter of index " +
                            std::to_string(index));
  return table[static_cast<std::size_t>(index)];
}

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
  const int index = parameter_index(plant, key);
  if (index >= 0) return given[static_cast<std::size_t>(index)];
  check_known(key);
  return false;
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
