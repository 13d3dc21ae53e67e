#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/plant/rig.hpp"

namespace rigcal::model {

/// A rig for use in other simulators, in the form in which an FMU reads it from its resources.
struct ExportedRig {
  std::string guid;  ///< GUID of the model description
  Rig rig;
  ParameterValues values = ParameterValues::defaults(PlantKind::load_pressure);
  double tolerance = 1e-6;  ///< for co-simulation, unless the importer sets one
};

/// Table indices of the parameters that an importer may change, in the order of the table: those of
/// the plant, the terms and the controller gains of the rig. Inputs of the FMU are excluded, and so
/// are sensors, which are not part of the rig.
std::vector<int> exported_parameters(const ExportedRig& rig);

/// Whether a parameter may change while the rig runs. Initial values and the sampling time of the
/// controller may not.
bool is_tunable(const ParameterSpec& spec);

/// Whether an input of the FMU replaces a parameter.
bool is_input(const ParameterSpec& spec);

/// Name of the rig's file in the resources of an FMU.
inline constexpr const char* kRigFile = "rig.txt";

/// Returns the contents of this file, from which read_exported_rig() restores every bit of each
/// value.
std::string exported_rig_text(const ExportedRig& rig);

/// @throws std::runtime_error  if the file is invalid; the message gives file and line, what was
///                             found and what was expected
ExportedRig read_exported_rig(const std::filesystem::path& file);

}  // namespace rigcal::model
