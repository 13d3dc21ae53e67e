#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/comparison/stored_comparison.hpp"
#include "report/store/stored.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

/// A fit or validation that is compared with others.
struct Compared {
  std::string name;            ///< what tells it from the others: as short a path as that takes
  std::filesystem::path file;  ///< fit.json, or validation.json where there is no fit
  StoredFit result;
  bool of_tables = false;                      ///< a fit to published tables: it has no records
  std::vector<std::string> published_numbers;  ///< that it was fitted to
};

/// A fit.json or validation.json as one of those that are compared.
///
/// @throws InputError  it is not what this version writes
Compared compared_of(const Json& json, const std::filesystem::path& file, const std::string& name);

/// Reads the fit.json or validation.json of a folder.
///
/// @param name  in the comparison
/// @throws InputError  it is missing, no JSON, or not what this version writes
Compared load_compared_file(const std::filesystem::path& file, const std::string& name);

/// Reads the fit (else the validation) of each folder.
///
/// @throws InputError  a folder holds neither; a file is no JSON, or not what this version writes
std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders);

/// Estimates, scores and records side by side, each difference from the first result with its
/// significance, the leak along dates and temperatures.
///
/// @param results  two or more; the first is what the others are compared with
/// @throws InputError  a result counts what cannot be
StoredComparison compared(const std::vector<Compared>& results, const Provenance& provenance);

/// Reads the comparison.json of a folder.
///
/// @throws InputError  as load(); a list has not an entry per result
StoredComparison load_comparison(const ReadFile& read, const std::string& where);

}  // namespace rigcal::report
