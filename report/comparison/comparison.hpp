#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/comparison/stored_comparison.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {

/// A fit or validation that is compared with others.
struct Compared {
  std::string name;            ///< name of the result: the shortest path that is unique
  std::filesystem::path file;  ///< fit.json, or validation.json where there is no fit
  StoredFit result;
  bool of_tables = false;                      ///< a fit to published tables: it has no records
  std::vector<std::string> published_numbers;  ///< the numbers that it was fitted to
};

/// A fit.json or validation.json as one of the compared results.
///
/// @throws InputError  not in the format of this version
Compared compared_of(const Json& json, const std::filesystem::path& file, const std::string& name);

/// Reads the fit.json or validation.json of a folder.
///
/// @param name  in the comparison
/// @throws InputError  missing, not JSON, or not in the format of this version
Compared load_compared_file(const std::filesystem::path& file, const std::string& name);

/// Reads the fit (else the validation) of each folder.
///
/// @throws InputError  a folder has neither; a file is not JSON, or not in the format of this
///                     version
std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders);

/// Compares estimates, scores and records, each difference from the first result with its
/// significance, and the leak over dates and temperatures.
///
/// @param results  two or more; the others are compared with the first
/// @throws InputError  a result has impossible counts
StoredComparison compared(const std::vector<Compared>& results, const Provenance& provenance);

/// Reads the comparison.json of a folder.
///
/// @throws InputError  as load(); a list has not an entry per result
StoredComparison load_comparison(const ReadFile& read, const std::string& where);

}  // namespace rigcal::report
