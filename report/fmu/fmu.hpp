#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/fmi/exported_rig.hpp"

namespace rigcal::report {

/// Content of an FMU.
struct FmuRequest {
  std::string name;        ///< name of the rig, for people
  std::string identifier;  ///< for C: letters, digits and "_", no digit first
  model::ExportedRig rig;  ///< its GUID is filled in
  double start_s = 0.0;    ///< start of the default experiment
  double stop_s = 1.0;
  double step_s = 1e-3;
  /// Origin of the values, for the documentation: label and words.
  std::vector<std::pair<std::string, std::string>> origin;
};

struct FmuFile {
  std::string path;  ///< within the archive
  std::string content;
};

/// The files of an FMU for FMI 2.0, model exchange and co-simulation. The same request gives the
/// same bytes.
std::vector<FmuFile> fmu_files(FmuRequest request);

/// "shake table 2" -> "shake_table_2"
std::string fmu_identifier(const std::string& name);

}  // namespace rigcal::report
