#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/fmi/exported_rig.hpp"

namespace rigcal::report {

/// What an FMU is made from.
struct FmuRequest {
  std::string name;        ///< display name of the rig
  std::string identifier;  ///< name for C code: letters, digits and "_", not starting with a digit
  model::ExportedRig rig;  ///< the rig; its GUID is filled in by fmu_files()
  double start_s = 0.0;    ///< start of the default experiment
  double stop_s = 1.0;
  double step_s = 1e-3;
  /// Origin of the values for the documentation, as pairs of label and text.
  std::vector<std::pair<std::string, std::string>> origin;
};

struct FmuFile {
  std::string path;  ///< path within the archive
  std::string content;
};

/// Returns the files of an FMU for FMI 2.0, with model exchange and co-simulation. The same request
/// always gives the same bytes.
std::vector<FmuFile> fmu_files(FmuRequest request);

/// Converts a name to an identifier: "shake table 2" -> "shake_table_2".
std::string fmu_identifier(const std::string& name);

}  // namespace rigcal::report
