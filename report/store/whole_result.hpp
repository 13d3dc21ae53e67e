#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "report/store/json_fields.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// The result that a folder holds already, where it is whole and would be made again as it is: by
/// the same version, from inputs of the same content, with the same seed and options, not stopped
/// before its end, and each file that it names is there as it was written.
///
/// @param name  of its JSON: "fit.json"
std::optional<Json> whole_result(const std::filesystem::path& folder, const std::string& name,
                                 const Provenance& provenance);

}  // namespace rigcal::report
