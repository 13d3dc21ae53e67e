#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/store/json.hpp"
#include "report/store/stored_provenance.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

inline constexpr const char* kComparisonSchema = "rigcal.comparison/1";

/// A fit.json or validation.json that is compared with others.
struct Compared {
  std::string name;            ///< what tells it from the others: as short a path as that takes
  std::filesystem::path file;  ///< fit.json, or validation.json where there is no fit
  Json result;
};

/// Reads the fit (else the validation) of each folder; a fit to published tables has no conditions.
///
/// @throws InputError  a folder holds neither; a file is no JSON, or not what this version writes
std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders);

/// comparison.json as docs/command-line.md describes it: estimates, scores and records side by
/// side, each difference from the first result with its significance, the leak along dates and
/// temperatures; `status` comes first: `done`, or `failed` with fewer than two usable results.
///
/// @param results  two or more; the first is what the others are compared with
/// @throws InputError  a file is not what this version writes
Json comparison_json(const std::vector<Compared>& results, const Provenance& provenance);

/// The same for people.
///
/// @throws InputError  it holds what a result of this version does not
std::string comparison_text(const Json& comparison, const Style& style);

}  // namespace rigcal::report
