#include "report/store/checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/json/read_json.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_residual_tests.hpp"

namespace rigcal::report {
namespace {

constexpr const char* kSchema = "rigcal.checkpoint/1";
constexpr const char* kKind = "checkpoint of rigcal fit";

/// Returns the data that must be unchanged for a fit to resume.
Json identity(const Provenance& provenance) {
  Json json;
  json["version"] = std::string(version());
  json["revision"] = std::string(revision());
  json["seed"] = provenance.seed;
  json["options"] = Json::object();
  for (const auto& [name, value] : provenance.options) json["options"][name] = value;
  json["inputs"] = Json::array();
  for (const InputFile& input : provenance.inputs) json["inputs"].push_back(input.sha256);
  return json;
}

/// Thrown for invalid content of a checkpoint, which what() describes.
class NoCheckpoint : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads an integer within a range. Values out of range are rejected before the conversion, which
/// would change them or be undefined.
///
/// @throws NoCheckpoint  if the value is not an integer or is out of range
template <typename Integer>
Integer whole(const Json& json, const std::string& key, Integer lowest, Integer highest) {
  const Json& value = json.at(key);
  const double number = value.is_number_integer() ? value.get<double>() : std::nan("");
  if (number >= static_cast<double>(lowest) && number <= static_cast<double>(highest))
    return value.get<Integer>();
  throw NoCheckpoint(fmt::format("key '{}': found {}, expected a whole number from {} to {}", key,
                                 value.is_number() ? value.dump() : "no number", lowest, highest));
}

constexpr int kMostCounted = 1'000'000'000;

Json counters_json(const calib::EvaluationCounters& counters) {
  Json kept = Json::array();
  for (const auto& [key, count] : counters.kept)
    kept.push_back({key.first, static_cast<int>(key.second), count});
  return {{"evaluations", counters.evaluations},
          {"failure_count", counters.failure_count},
          {"failures", json_of(counters.failures)},
          {"kept", kept}};
}

/// @param file  name for messages
calib::EvaluationCounters counters_from(const Json& json, const std::string& file) {
  calib::EvaluationCounters counters;
  constexpr long kMostEvaluations = long{1} << 53;
  counters.evaluations = whole(json, "evaluations", 0L, kMostEvaluations);
  counters.failure_count = whole(json, "failure_count", 0L, kMostEvaluations);
  read_into(JsonNode(json.at("failures"), file, "ledger.failures", kKind), counters.failures);
  for (const Json& each : json.at("kept")) {
    // Each entry is [condition, status, count].
    const Json entry{{"condition", each.at(0)}, {"status", each.at(1)}, {"count", each.at(2)}};
    const auto status = static_cast<model::SimulationStatus>(
        whole(entry, "status", 0, static_cast<int>(model::SimulationStatus::no_equilibrium)));
    const auto condition = static_cast<std::size_t>(whole(entry, "condition", 0, kMostCounted));
    counters.kept[{condition, status}] = whole(entry, "count", 0, kMostCounted);
  }
  return counters;
}

void require_same_fit(const std::string& file, const Json& found, const Json& expected) {
  for (const auto& [key, value] : expected.items()) {
    const auto other = found.find(key);
    if (other != found.end() && *other == value) continue;
    throw InputError({file}, fmt::format("is the checkpoint of another fit: its {} differ{}; "
                                         "expected the same, or a fit without --resume",
                                         key, key.back() == 's' ? "" : "s"));
  }
}

/// Checks the hash of a checkpoint, since plausible numbers may still have been edited.
///
/// @throws NoCheckpoint  if the content was changed since it was written
void require_own_hash(Json json) {
  const std::string hash = json.at("sha256").get<std::string>();
  json.erase("sha256");
  if (sha256_of_text(json_text(json)) != hash)
    throw NoCheckpoint(
        "was changed since it was written; expected it unchanged, or a fit without --resume");
}

}  // namespace

std::string fit_identity(const Provenance& provenance) {
  return sha256_of_text(json_text(identity(provenance)));
}

std::string checkpoint_text(const calib::Checkpoint& checkpoint, const Provenance& provenance) {
  Json json;
  json["schema"] = kSchema;
  json["fit"] = identity(provenance);
  json["starts"] = json_of(checkpoint.starts);
  json["best"] = checkpoint.best;
  json["best_z"] = checkpoint.best_z;
  json["ledger"] = counters_json(checkpoint.counters);
  json["sha256"] = sha256_of_text(json_text(json));
  return json_text(json);
}

bool is_checkpoint(const std::filesystem::path& file) {
  std::string head(1000, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<long>(head.size()));
  return head.find(fmt::format("\"schema\": \"{}\"", kSchema)) != std::string::npos;
}

calib::Checkpoint read_checkpoint(const std::filesystem::path& file, const Provenance& provenance) {
  JsonLimits limits;
  limits.number = std::numeric_limits<double>::max();  // an intermediate cost may be any number
  const Json json =
      read_json(file, "a checkpoint of rigcal fit, or a fit without --resume", limits);
  try {
    if (json.at("schema") != kSchema) {
      throw InputError({file.string()}, fmt::format("key 'schema': expected \"{}\"", kSchema));
    }
    require_same_fit(file.string(), json.at("fit"), identity(provenance));
    calib::Checkpoint checkpoint;
    read_into(JsonNode(json.at("starts"), file.string(), "starts", kKind), checkpoint.starts);
    // Starts are kept in the order in which they ran.
    for (std::size_t i = 0; i < checkpoint.starts.size(); ++i) {
      if (checkpoint.starts[i].number != static_cast<int>(i) + 1)
        throw NoCheckpoint("key 'starts': expected numbers from 1");
    }
    checkpoint.best = whole(json, "best", 0, static_cast<int>(checkpoint.starts.size()));
    checkpoint.best_z = json.at("best_z").get<std::vector<double>>();
    checkpoint.counters = counters_from(json.at("ledger"), file.string());
    require_own_hash(json);
    return checkpoint;
  } catch (const NoCheckpoint& error) {
    throw InputError({file.string()}, error.what());
  } catch (const Json::exception& error) {
    throw InputError(
        {file.string()},
        fmt::format(
            "is not a checkpoint of rigcal fit: {}; expected one, or a fit without --resume",
            error.what()));
  }
}

}  // namespace rigcal::report
