#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/simulate.hpp"

namespace rigcal::model {

/// A rig for other simulators, as an FMU reads it from its resources.
struct ExportedRig {
  std::string guid;  ///< GUID of the model description
  Rig rig;
  ParameterValues values = ParameterValues::defaults(PlantKind::load_pressure);
  double tolerance = 1e-6;  ///< for co-simulation, if the importer states none
};

/// Table indices of the parameters that an importer may change, in the order of the table: those of
/// the plant, and the terms and controller gains of the rig. Inputs of the FMU and sensors, which
/// are not part of the rig, are excluded.
std::vector<int> exported_parameters(const ExportedRig& rig);

/// Whether a parameter may be changed while the rig runs: not initial values, nor the sampling time
/// of the controller.
bool is_tunable(const ParameterSpec& spec);

/// Whether an input of the FMU takes the place of a parameter.
bool is_input(const ParameterSpec& spec);

/// Name of the file in the resources of an FMU.
inline constexpr const char* kRigFile = "rig.txt";

/// The lines of that file; read_exported_rig() gives the same bits back.
std::string exported_rig_text(const ExportedRig& rig);

/// @throws std::runtime_error  file, line, what was found and what was expected
ExportedRig read_exported_rig(const std::filesystem::path& file);

}  // namespace rigcal::model
