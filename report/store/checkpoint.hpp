#pragma once

#include <filesystem>
#include <string>

#include "calib/search/checkpoint.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// File that `fit` keeps in its result folder between two starts.
inline constexpr const char* kCheckpointFile = "checkpoint.json";

/// Hash of everything that must be equal for a fit to continue: inputs, options, seed and version.
std::string fit_identity(const Provenance& provenance);

/// Text of a checkpoint with the provenance of its fit. Numbers read back to the same bits.
std::string checkpoint_text(const calib::Checkpoint& checkpoint, const Provenance& provenance);

/// Whether a file is a checkpoint of any fit, complete or not.
bool is_checkpoint(const std::filesystem::path& file);

/// @param provenance  of the fit that is to go on
/// @throws InputError  the file cannot be read, is no checkpoint, or is that of another fit: other
///                     inputs, options, seed or version
calib::Checkpoint read_checkpoint(const std::filesystem::path& file, const Provenance& provenance);

}  // namespace rigcal::report
