#pragma once

#include <filesystem>
#include <string>

#include "calib/search/checkpoint.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// File in the result folder to which `fit` saves its state between two starts.
inline constexpr const char* kCheckpointFile = "checkpoint.json";

/// Returns the hash of everything that must be unchanged for a fit to resume: inputs, options, seed
/// and version.
std::string fit_identity(const Provenance& provenance);

/// Writes a checkpoint with the provenance of its fit as text. Numbers round-trip exactly.
std::string checkpoint_text(const calib::Checkpoint& checkpoint, const Provenance& provenance);

/// Whether a file is a checkpoint of any fit, complete or not.
bool is_checkpoint(const std::filesystem::path& file);

/// Reads a checkpoint.
///
/// @param provenance  provenance of the fit to be resumed
/// @throws InputError  if the file cannot be read, is not a checkpoint, or belongs to another fit
///                     (with other inputs, options, seed or version)
calib::Checkpoint read_checkpoint(const std::filesystem::path& file, const Provenance& provenance);

}  // namespace rigcal::report
