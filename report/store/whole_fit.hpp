#pragma once

#include <filesystem>
#include <optional>

#include "report/store/provenance.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// The fit in a folder, if it is complete and would be the same again: by the same version, from
/// inputs of the same content, with the same seed and options, not stopped, and with each listed
/// file present and unchanged.
std::optional<StoredFit> whole_fit(const std::filesystem::path& folder,
                                   const Provenance& provenance);

}  // namespace rigcal::report
