#include "report/store/stored.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "datasets/campaign/condition_id.hpp"
#include "report/json/json_fields.hpp"
#include "report/json/read_json.hpp"

namespace rigcal::report {
namespace {

std::string path_in(const std::string& where, const std::string& name) {
  return (std::filesystem::path(where) / name).string();
}

Json parsed(const ReadFile& read, const std::string& where, const std::string& name) {
  const auto file = read(name);
  if (!file)
    throw InputError({path_in(where, name)}, "is missing; make the result again with this version");
  return parse_json(file->content, path_in(where, name));
}

/// Returns the schema of the result that residual_tests.json belongs to.
std::string schema_of_curves(const ReadFile& read, const std::string& where) {
  if (const auto curves = made<StoredCurves>(read("residual_tests.json"))) return curves->of;
  return text_of(parsed(read, where, "residual_tests.json"), "of");
}

std::shared_ptr<const Table> table_or_empty(const ReadFile& read, const std::string& where,
                                            const std::string& name) {
  auto table = table_in(read, where, name);
  return table ? table : std::make_shared<const Table>();
}

/// Checks the id of a condition. It is part of a file name, and a result from an unknown source
/// must not make it refer to another folder.
void require_id(const std::string& id, const char* key, const std::string& file) {
  if (datasets::is_condition_id(id)) return;
  throw InputError({file}, fmt::format("key '{}' of a condition: found \"{}\", expected {}", key,
                                       id.substr(0, 40), datasets::condition_id_rule()));
}

void require_length(std::size_t found, std::size_t expected, const char* list,
                    const std::string& file) {
  if (found == expected) return;
  throw InputError({file}, fmt::format("{}: found {} entries, expected {}", list, found, expected));
}

/// Checks that the two coordinates of each curve have equal lengths, since pages draw them.
void require_matching(const StoredCurves& curves, const std::string& file) {
  for (const auto& [condition, channels] : curves.conditions) {
    for (const auto& [channel, found] : channels) {
      if (!found) continue;
      const auto require = [&, &id = condition, &key = channel](
                               const auto& list, const auto& beside, const char* name) {
        require_length(list.size(), beside.size(),
                       fmt::format("{} of {}, condition {}", name, info(key).key, id).c_str(),
                       file);
      };
      require(found->periodogram.density, found->periodogram.frequency_hz, "periodogram.density");
      require(found->normality.residual_quantile, found->normality.normal_quantile,
              "normality.residual_quantile");
    }
  }
}

void require_matching(const StoredFit& fit, const std::string& file) {
  for (const calib::FittedParameter& parameter : fit.parameters) {
    if (parameter.profile)
      require_length(parameter.profile->rises.size(), parameter.profile->values.size(),
                     fmt::format("profile.rises of {}", parameter.name).c_str(), file);
  }
}

}  // namespace

Json load_json(const ReadFile& read, const std::string& where, const std::string& name) {
  Json json = parsed(read, where, name);
  const bool of_fit = name == "fit.json";
  const std::string expected =
      of_fit ? kFitSchema : fmt::format("rigcal.{}/1", std::filesystem::path(name).stem().string());
  const bool has_schema = json.is_object() && json.contains("schema");
  if (has_schema && (json["schema"] == expected || (of_fit && json["schema"] == kEarlierFitSchema)))
    return json;
  throw InputError(
      {path_in(where, name)},
      fmt::format("found {}; expected \"schema\": \"{}\"",
                  has_schema ? "\"schema\": " + json["schema"].dump() : "no schema", expected));
}

std::variant<Calibration, StoredTablesFit> load_calibration(const ReadFile& read,
                                                            const std::string& where, int threads) {
  Calibration stored;
  const bool is_fit = read("fit.json") &&
                      (!read("validation.json") || is_fit_schema(schema_of_curves(read, where)));
  stored.file = is_fit ? "fit.json" : "validation.json";
  if (const auto tables = made<StoredTablesFit>(read(stored.file))) return *tables;
  const auto object = made<StoredFit>(read(stored.file));
  if (object) {
    stored.result = *object;
  } else {
    const Json json = load_json(read, where, stored.file);
    if (is_fit && is_of_tables(json)) return as<StoredTablesFit>(json, where, stored.file);
    stored.result = as<StoredFit>(json, where, stored.file);
    as_of_now(stored.result.schema, stored.result.parameters);
  }
  const ReadFile own = files_of_run(read, stored.result.provenance, where, stored.file);
  require_matching(stored.result, path_in(where, stored.file));
  stored.curves = load<StoredCurves>(own, where, "residual_tests.json");
  require_matching(stored.curves, path_in(where, "residual_tests.json"));
  std::vector<std::string> names;
  for (const calib::ConditionResult& condition : stored.result.conditions) {
    require_id(condition.id, "id", path_in(where, stored.file));
    names.push_back("residuals/" + condition.id + ".csv");
  }
  const auto series = [own, where, names](std::size_t i) {
    return table_or_empty(own, where, names[i]);
  };
  if (object) {
    stored.series = series;
    return stored;
  }
  std::vector<std::shared_ptr<const Table>> tables(names.size());
  parallel_for(names.size(), threads, [&](std::size_t i) { tables[i] = series(i); });
  stored.series = [tables](std::size_t i) { return tables[i]; };
  return stored;
}

LeakTableFiles load_leak_table(const ReadFile& read, const std::string& where) {
  LeakTableFiles stored{load<StoredLeakTable>(read, where, "leak_table.json"), {}};
  const ReadFile own = files_of_run(read, stored.result.provenance, where, "leak_table.json");
  for (const diagnosis::FeatureRow& feature : stored.result.features) {
    if (const auto series = table_in(own, where, "levels/" + level_file(feature.level)))
      stored.levels.emplace_back(feature.level, *series);
  }
  return stored;
}

ParityFiles load_parity(const ReadFile& read, const std::string& where) {
  ParityFiles stored{load<StoredParity>(read, where, "parity.json"), {}};
  const ReadFile own = files_of_run(read, stored.result.provenance, where, "parity.json");
  for (const diagnosis::ParityRecord& record : stored.result.records) {
    require_id(record.condition, "condition", path_in(where, "parity.json"));
    if (stored.series.contains(record.condition)) continue;
    if (auto series = table_in(own, where, "parity/" + record.condition + ".csv"))
      stored.series.emplace(record.condition, std::move(series));
  }
  return stored;
}

StoredDiagnosis load_diagnosis(const ReadFile& read, const std::string& where) {
  auto diagnosis = load<StoredDiagnosis>(read, where, "diagnosis.json");
  for (const diagnosis::ClassLimit& limit : diagnosis.found.class_limits) {
    require_length(limit.coefficients_ci95.size(), limit.coefficients.size(),
                   "coefficients_ci95 of class_limits", path_in(where, "diagnosis.json"));
  }
  return diagnosis;
}

AverageFiles load_average(const ReadFile& read, const std::string& where) {
  AverageFiles stored{load<StoredAverage>(read, where, "average.json"), {}};
  const ReadFile own = files_of_run(read, stored.result.provenance, where, "average.json");
  for (const StoredRecord& record : stored.result.records) {
    require_id(record.condition, "condition", path_in(where, "average.json"));
    stored.series.push_back(table_or_empty(own, where, "averaged/" + record.condition + ".csv"));
  }
  return stored;
}

PlanFiles load_plan(const ReadFile& read, const std::string& where) {
  PlanFiles stored{load<StoredPlan>(read, where, "plan.json"), {}};
  StoredPlan& plan = stored.result;
  for (calib::PlannedRecord& record : plan.records) {
    for (auto* list : {&record.sd_alone, &record.sd_without}) {
      if (list->empty())
        list->resize(plan.parameters.size());  // 0.1.0: a record that could not be simulated
      require_length(list->size(), plan.parameters.size(), "sd_alone or sd_without of a record",
                     path_in(where, "plan.json"));
    }
  }
  if (!plan.design) return stored;
  for (const calib::FamilyTrial& family : plan.design->families) {
    if (family.found)
      require_length(family.sd.size(), plan.design->parameters.size(), "sd of a family",
                     path_in(where, "plan.json"));
  }
  const ReadFile own = files_of_run(read, plan.provenance, where, "plan.json");
  if (const auto response = table_in(own, where, kResponseFile)) stored.response = *response;
  return stored;
}

std::string plain_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '-';
    name += plain ? c : '_';
  }
  return name;
}

std::string level_file(const std::string& level) { return plain_name(level) + ".csv"; }

}  // namespace rigcal::report
