#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "report/store/result_files.hpp"
#include "report/store/stored/stored_diagnosis.hpp"
#include "report/store/stored/stored_fit.hpp"
#include "report/store/stored/stored_leak_table.hpp"
#include "report/store/stored/stored_parity.hpp"
#include "report/store/stored/stored_plan.hpp"
#include "report/store/stored/stored_record.hpp"
#include "report/store/stored/stored_tables_fit.hpp"

// Reads the files of a result folder. All functions throw InputError if a file is missing or is not
// valid JSON or a valid table. `where` is the folder, for messages.

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// A fit or validation.
struct Calibration {
  std::string file;  ///< fit.json or validation.json
  StoredFit result;
  StoredCurves curves;
  /// Returns the residuals table of a condition by its index; empty if there is none.
  std::function<std::shared_ptr<const Table>(std::size_t)> series;
};

/// Loads a fit or validation. If the folder contains both, loads the one that residual_tests.json
/// belongs to. A fit to published tables has no further files.
///
/// The series of a result that this process has made are asked for one by one when they are needed,
/// so that not all are in memory at once.
///
/// @param threads  number of threads for reading the series
std::variant<Calibration, StoredTablesFit> load_calibration(const ReadFile& read,
                                                            const std::string& where, int threads);

/// A leak table, with the feature series of each level.
struct LeakTableFiles {
  StoredLeakTable result;
  std::vector<std::pair<std::string, Table>> levels;
};
LeakTableFiles load_leak_table(const ReadFile& read, const std::string& where);

/// Parity residuals, with the series of each condition, by its id.
struct ParityFiles {
  StoredParity result;
  std::map<std::string, std::shared_ptr<const Table>> series;
};
ParityFiles load_parity(const ReadFile& read, const std::string& where);

StoredDiagnosis load_diagnosis(const ReadFile& read, const std::string& where);

/// An average, with the mean series of each record, shape (records); empty where a file is missing.
struct AverageFiles {
  StoredAverage result;
  std::vector<std::shared_ptr<const Table>> series;
};
AverageFiles load_average(const ReadFile& read, const std::string& where);

/// A plan, with the predicted response to the designed drive; empty without a design.
struct PlanFiles {
  StoredPlan result;
  Table response;
};
PlanFiles load_plan(const ReadFile& read, const std::string& where);

/// Loads a JSON result, and checks that its schema matches the name of its file.
Json load_json(const ReadFile& read, const std::string& where, const std::string& name);

/// Converts JSON to a stored type.
///
/// @param name  file name in the folder `where`, for messages
template <typename Stored>
Stored as(const Json& json, const std::string& where, const std::string& name) {
  Stored value;
  read_into(JsonNode(json, (std::filesystem::path(where) / name).string(), "", name), value);
  return value;
}

/// Loads a JSON result as a stored type: the object itself if this process has made the file.
template <typename Stored>
Stored load(const ReadFile& read, const std::string& where, const std::string& name) {
  if (const auto object = made<Stored>(read(name))) return *object;
  return as<Stored>(load_json(read, where, name), where, name);
}

/// Makes a text usable in a file name: keeps letters, digits, "." and "-", and replaces every other
/// character with "_".
std::string plain_name(const std::string& text);

/// Returns the name of the file in levels/ with the series of a leak level.
std::string level_file(const std::string& level);

}  // namespace rigcal::report
