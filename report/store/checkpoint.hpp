#pragma once

#include <filesystem>
#include <string>

#include "calib/search/checkpoint.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// What `fit` keeps in its result folder between two starts.
inline constexpr const char* kCheckpointFile = "checkpoint.json";

/// Hash of what must be the same for a fit to go on: inputs, options, seed and version.
std::string fit_identity(const Provenance& provenance);

/// A checkpoint with what its fit was made from; numbers read back to the same bits.
std::string checkpoint_text(const calib::Checkpoint& checkpoint, const Provenance& provenance);

/// Whether a file is a checkpoint of any fit, complete or not.
bool is_checkpoint(const std::filesystem::path& file);

/// @param provenance  of the fit that is to go on
/// @throws InputError  the file cannot be read, is no checkpoint, or is that of another fit: other
///                     inputs, options, seed or version
calib::Checkpoint read_checkpoint(const std::filesystem::path& file, const Provenance& provenance);

}  // namespace rigcal::report
