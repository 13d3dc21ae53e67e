#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/comparison/stored_comparison.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// A fit or validation to be compared with others.
struct Compared {
  std::string name;            ///< shortest path that is unique among the results
  std::filesystem::path file;  ///< fit.json, or validation.json if there is no fit
  StoredFit result;
  bool of_tables = false;                      ///< a fit to published tables, without records
  std::vector<std::string> published_numbers;  ///< the published tables used in the fit, by number
};

/// Prepares a parsed fit.json or validation.json for a comparison.
///
/// @throws InputError  if the file does not have the format of this version
Compared compared_of(const Json& json, const std::filesystem::path& file, const std::string& name);

/// Reads one fit.json or validation.json.
///
/// @param name         name of the result in the comparison
///
/// @throws InputError  if the file is missing, is not JSON or does not have the format of this
///                     version
Compared load_compared_file(const std::filesystem::path& file, const std::string& name);

/// Reads the fit in each folder, or the validation if there is no fit.
///
/// @throws InputError  if a folder contains neither, or a file is not JSON or does not have the
///                     format of this version
std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders);

/// Compares estimates, scores and records. Each difference from the first result is given with its
/// significance. Leak estimates are also followed over dates and temperatures.
///
/// @param results      two or more; the others are compared with the first
///
/// @throws InputError  if a result contains impossible counts
StoredComparison compared(const std::vector<Compared>& results, const Provenance& provenance);

/// Reads the comparison.json in a folder.
///
/// @throws InputError  as for load(), or if a list does not have one entry per result
StoredComparison load_comparison(const ReadFile& read, const std::string& where);

}  // namespace rigcal::report
