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
  std::string path;  ///< relative to the folder, with "/" as separator
  std::string sha256;
  std::string verb;  ///< verb that wrote it; empty if an older version wrote it
  RIGCAL_DESCRIBE(path, sha256, verb)
};

/// rigcal-manifest.json: the files in a folder that rigcal wrote, with their hashes. While a run
/// moves its files into place, a path is listed twice, with its old and its new hash.
struct StoredManifest {
  std::string schema = kManifestSchema;
  std::string version;  ///< version of rigcal
  std::vector<ManifestFile> files;
  RIGCAL_DESCRIBE(schema, version, files)
};

/// Writes the text of a manifest, with the files sorted by path.
std::string manifest_text(const std::vector<ManifestFile>& files);

/// Reads the files from the manifest of a folder. Without a manifest, calls rigcal_files().
///
/// @throws InputError  if the manifest does not have this version's schema, or names a file outside
///                     the folder
std::vector<ManifestFile> manifest_files(const std::filesystem::path& folder);

/// Finds results that older versions wrote without a manifest. A file that a result lists in
/// `provenance.files` counts if it has the stated hash. Any other file counts if both its name and
/// its content match a rigcal result. A campaign.toml never counts, since users edit it.
std::vector<ManifestFile> rigcal_files(const std::filesystem::path& folder);

}  // namespace rigcal::report
