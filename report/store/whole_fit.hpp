#pragma once

#include <filesystem>
#include <optional>

#include "report/store/provenance.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// The fit that a folder holds already, where it is whole and would be made again as it is: by the
/// same version, from inputs of the same content, with the same seed and options, not stopped
/// before its end, and each file that it names is there as it was written.
std::optional<StoredFit> whole_fit(const std::filesystem::path& folder,
                                   const Provenance& provenance);

}  // namespace rigcal::report
