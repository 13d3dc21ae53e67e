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
  std::string verb;  ///< verb that wrote it; empty: a version without manifests
  RIGCAL_DESCRIBE(path, sha256, verb)
};

/// rigcal-manifest.json: the files of a folder that rigcal wrote, with their hashes. While a run
/// moves its files, a path is listed twice: with the old hash and with the new one.
struct StoredManifest {
  std::string schema = kManifestSchema;
  std::string version;  ///< version of rigcal
  std::vector<ManifestFile> files;
  RIGCAL_DESCRIBE(schema, version, files)
};

/// Text of a manifest with its files sorted by path.
std::string manifest_text(const std::vector<ManifestFile>& files);

/// Files in the manifest of a folder, or those of rigcal_files() if there is no manifest.
///
/// @throws InputError  not a manifest of this version, or one that names a file outside the folder
std::vector<ManifestFile> manifest_files(const std::filesystem::path& folder);

/// Finds results of versions that wrote no manifest. A file that the `provenance.files` of a result
/// names counts if it has the stated hash. Any other file counts if both its name and its content
/// are those of a rigcal result. A campaign.toml never counts, since users edit it.
std::vector<ManifestFile> rigcal_files(const std::filesystem::path& folder);

}  // namespace rigcal::report
