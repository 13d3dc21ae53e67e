#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::model {

enum class ParameterKind {
  plant,       ///< physical parameter of the plant; must have a value
  term,        ///< optional term, absent unless given
  controller,  ///< gains and limits; off unless given
  sensor,      ///< offset, gain and lag of the sensor of a recorded channel
  initial,     ///< state at the first sample
};

std::string_view to_string(ParameterKind kind);

/// All that the program knows about one parameter. The campaign file, `rigcal params`, the results
/// and the documentation are derived from this row.
struct ParameterSpec {
  std::string_view key;      ///< name in the campaign file: "mass"
  std::string_view name;     ///< name in results, ending in the SI unit: "mass_kg"
  std::string_view symbol;   ///< symbol in the equations: "m"
  std::string_view unit;     ///< SI unit as UDUNITS reads it: "kg"; "1" if dimensionless
  std::string_view meaning;  ///< one-line description
  std::string_view source;   ///< equation or document
  ParameterKind kind = ParameterKind::plant;
  double lower = 0.0;                     ///< smallest plausible value (SI)
  double upper = 0.0;                     ///< largest plausible value (SI)
  std::optional<double> default_value{};  ///< value if none is given; std::nullopt: must be given
  bool can_be_fitted = true;  ///< false if the model is not differentiable with respect to it
};

/// Returns true for a lag of first order, of the valve or a sensor. A lag of zero is none.
bool is_lag(const ParameterSpec& spec);

/// Index in the list of plants (plants.hpp), for code that refers to a plant by name.
enum class PlantKind { load_pressure, two_chamber, linkage };

/// "load_pressure" -> PlantKind; std::nullopt for an unknown name.
std::optional<PlantKind> plant_from_name(std::string_view name);
std::string_view to_string(PlantKind plant);
std::vector<std::string> plant_names();

/// The parameter table of a plant with its valve, controller, sensors and initial state. A row's
/// position is the index of that parameter everywhere (values, free lists, Jacobians).
std::span<const ParameterSpec> parameter_table(PlantKind plant);

/// The row of the table with this index. Throws std::out_of_range if there is none, as for the -1
/// of a key that the plant has not.
const ParameterSpec& parameter_spec(PlantKind plant, int index);

/// Index of a key in the table, or -1.
int parameter_index(PlantKind plant, std::string_view key);

/// Values of all parameters (SI, table order), and which of them were given. Optional terms take
/// part in the model only if they were given.
struct ParameterValues {
  PlantKind plant = PlantKind::load_pressure;
  std::vector<double> value;  ///< shape (table size); defaults where not given
  std::vector<bool> given;    ///< shape (table size)

  /// All parameters at their defaults, none given.
  static ParameterValues defaults(PlantKind plant);

  /// @throws std::invalid_argument  if the plant has no parameter with this key
  double operator[](std::string_view key) const;
  /// Returns false if only other plants have this parameter.
  /// @throws std::invalid_argument  if no plant has it
  bool is_given(std::string_view key) const;
  void set(std::string_view key, double value_si);
  void set(int index, double value_si);

  /// Keys of plant parameters without a value.
  std::vector<std::string> missing() const;
};

}  // namespace rigcal::model
