#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "report/store/stored/stored_diagnosis.hpp"
#include "report/store/stored/stored_fit.hpp"
#include "report/store/stored/stored_leak_table.hpp"
#include "report/store/stored/stored_parity.hpp"
#include "report/store/stored/stored_plan.hpp"
#include "report/store/stored/stored_record.hpp"
#include "report/store/stored/stored_tables_fit.hpp"
#include "report/store/table.hpp"

// The files of a result folder, read back. All throw InputError where a file is missing, or is no
// JSON or table; `where` is the folder, named in errors.

namespace rigcal::report {

using Json = nlohmann::ordered_json;

/// The text of a result file by its path in the result folder; nothing if there is none.
using ReadFile = std::function<std::optional<std::string>(const std::filesystem::path&)>;

/// The table of a result file by its path in the result folder; null where there is none.
using ReadTable = std::function<std::shared_ptr<const Table>(const std::filesystem::path&)>;

/// Reads from a folder on disk.
ReadFile files_in(const std::filesystem::path& folder);

/// A fit or validation.
struct Calibration {
  std::string file;  ///< fit.json or validation.json
  StoredFit result;
  StoredCurves curves;
  /// residuals/ of a condition by its number; an empty table where there is none.
  std::function<std::shared_ptr<const Table>(std::size_t)> series;
};

/// Loads a fit or validation. If a folder has both, it is the one that residual_tests.json belongs
/// to; a fit to published tables has no further files.
///
/// @param threads  for reading the series
/// @param made     tables from this run, which need not be read back; each is requested only when
///                 it is needed, so that they are not in memory together
std::variant<Calibration, StoredTablesFit> load_calibration(const ReadFile& read,
                                                            const std::string& where, int threads,
                                                            const ReadTable& made = {});

/// A leak table, and the series of its features by level.
struct LeakTableFiles {
  StoredLeakTable result;
  std::vector<std::pair<std::string, Table>> levels;
};
LeakTableFiles load_leak_table(const ReadFile& read, const std::string& where);

/// Parity residuals, and the series of each condition, by its id.
struct ParityFiles {
  StoredParity result;
  std::map<std::string, Table> series;
};
ParityFiles load_parity(const ReadFile& read, const std::string& where);

StoredDiagnosis load_diagnosis(const ReadFile& read, const std::string& where);

/// An average, and the mean of each record, shape (records); empty where it is missing.
struct AverageFiles {
  StoredAverage result;
  std::vector<Table> series;
};
AverageFiles load_average(const ReadFile& read, const std::string& where);

/// A plan, and the predicted response to the drive that was designed; empty without one.
struct PlanFiles {
  StoredPlan result;
  Table response;
};
PlanFiles load_plan(const ReadFile& read, const std::string& where);

/// A result in JSON, whose schema is that of the name of its file.
Json load_json(const ReadFile& read, const std::string& where, const std::string& name);

/// JSON as its type.
///
/// @param name  of the file in the folder `where`, for messages
template <typename Stored>
Stored as(const Json& json, const std::string& where, const std::string& name) {
  Stored value;
  read_into(JsonNode(json, (std::filesystem::path(where) / name).string(), "", name), value);
  return value;
}

/// A result as its type.
template <typename Stored>
Stored load(const ReadFile& read, const std::string& where, const std::string& name) {
  return as<Stored>(load_json(read, where, name), where, name);
}

/// A text as part of the name of a file: letters, digits, ".", "-", and "_" for all else.
std::string plain_name(const std::string& text);

/// File of one leak level's series beneath levels/.
std::string level_file(const std::string& level);

}  // namespace rigcal::report
