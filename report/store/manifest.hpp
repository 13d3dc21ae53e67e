#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/json/described.hpp"

namespace rigcal::report {

inline constexpr const char* kManifestFile = "rigcal-manifest.json";
inline constexpr const char* kManifestSchema = "rigcal.manifest/1";

/// A file that rigcal wrote.
struct ManifestFile {
  std::string path;  ///< relative to the folder, with "/"
  std::string sha256;
  std::string verb;  ///< that wrote it; empty: a version before there were manifests
  RIGCAL_DESCRIBE(path, sha256, verb)
};

/// rigcal-manifest.json: which files of a folder are rigcal's, each as it was written. A path
/// stands twice, as it was and as it shall be, while a run puts its files in their places.
struct StoredManifest {
  std::string schema = kManifestSchema;
  std::string version;  ///< of rigcal, which wrote it
  std::vector<ManifestFile> files;
  RIGCAL_DESCRIBE(schema, version, files)
};

/// In the order of their paths.
std::string manifest_text(const std::vector<ManifestFile>& files);

/// The files of a folder's manifest; where there is none, those that rigcal_files() finds.
///
/// @throws InputError  it is no manifest of this version, or names a file outside the folder
std::vector<ManifestFile> manifest_files(const std::filesystem::path& folder);

/// Results of versions that wrote no manifest. A file that `provenance.files` of a result names is
/// one if it has its hash; any other if it has a name that rigcal gives and begins as what rigcal
/// writes by that name. A campaign.toml is none: people edit it.
std::vector<ManifestFile> rigcal_files(const std::filesystem::path& folder);

}  // namespace rigcal::report
