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
  sensor,      ///< offset, gain and lag of recorded channels
  initial,     ///< state at the first sample
};

std::string_view to_string(ParameterKind kind);

/// All that the program knows about one parameter; the campaign file, `rigcal params`, the results
/// and the documentation are made from this row.
struct ParameterSpec {
  std::string_view key;      ///< name in the campaign file: "mass"
  std::string_view name;     ///< name in results, SI unit at its end: "mass_kg"
  std::string_view symbol;   ///< symbol in the equations: "m"
  std::string_view unit;     ///< SI unit as UDUNITS reads it: "kg"; "1" if dimensionless
  std::string_view meaning;  ///< one line
  std::string_view source;   ///< equation or document
  ParameterKind kind = ParameterKind::plant;
  double lower = 0.0;                     ///< no value below makes sense (SI)
  double upper = 0.0;                     ///< no value above makes sense (SI)
  std::optional<double> default_value{};  ///< value where none is given; none: must be given
  bool can_be_fitted = true;              ///< false where the model is not differentiable in it
};

/// Index in the list of plants (plants.hpp), for code that refers to a plant by name.
enum class PlantKind { load_pressure, two_chamber, linkage };

/// "load_pressure" -> PlantKind; empty if unknown.
std::optional<PlantKind> plant_from_name(std::string_view name);
std::string_view to_string(PlantKind plant);
std::vector<std::string> plant_names();

/// The parameter table of a plant with its valve, controller, sensors and initial state. The
/// position of a row is the index of that parameter everywhere (values, free lists, Jacobians).
std::span<const ParameterSpec> parameter_table(PlantKind plant);

/// Index of a key in the table, or -1.
int parameter_index(PlantKind plant, std::string_view key);

/// Values of every parameter (SI, table order) and which of them were given. Optional terms enter
/// the model only where given.
struct ParameterValues {
  PlantKind plant = PlantKind::load_pressure;
  std::vector<double> value;  ///< shape (table size); defaults where not given
  std::vector<bool> given;    ///< shape (table size)

  /// All parameters at their defaults, none given.
  static ParameterValues defaults(PlantKind plant);

  /// @throws std::invalid_argument  unknown key
  double operator[](std::string_view key) const;
  bool is_given(std::string_view key) const;
  void set(std::string_view key, double value_si);
  void set(int index, double value_si);

  /// Keys of plant parameters without a value.
  std::vector<std::string> missing() const;
};

}  // namespace rigcal::model
