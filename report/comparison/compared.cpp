#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/error.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {
namespace {

/// Shortens each path to its last components, keeping as many as are needed to distinguish the
/// paths.
std::vector<std::string> short_names(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::vector<std::string>> parts;
  std::size_t most = 1;
  for (const std::filesystem::path& folder : folders) {
    std::vector<std::string> names;
    for (const auto& part : std::filesystem::absolute(folder).lexically_normal()) {
      if (!part.empty() && part != "/") names.push_back(part.string());
    }
    most = std::max(most, names.size());
    parts.push_back(std::move(names));
  }
  std::vector<std::string> result;
  for (std::size_t count = 1; count <= most; ++count) {
    result.clear();
    for (const auto& names : parts) {
      std::string text;
      for (std::size_t i = names.size() - std::min(count, names.size()); i < names.size(); ++i)
        text += (text.empty() ? "" : "/") + names[i];
      result.push_back(text);
    }
    if (std::set<std::string>(result.begin(), result.end()).size() == result.size()) break;
  }
  return result;
}

}  // namespace

Compared compared_of(const Json& json, const std::filesystem::path& file, const std::string& name) {
  const std::string where = file.parent_path().string();
  const std::string result = file.filename().string();
  Compared compared{name, file, {}, is_of_tables(json), {}};
  if (!compared.of_tables) {
    compared.result = as<StoredFit>(json, where, result);
    as_of_now(compared.result.schema, compared.result.parameters);
    return compared;
  }
  const auto tables = as<StoredTablesFit>(json, where, result);
  compared.result = as_fit(tables);
  as_of_now(tables.schema, compared.result.parameters);
  for (const diagnosis::TableResidual& residual : tables.residuals)
    compared.published_numbers.push_back(residual.of);
  return compared;
}

StoredComparison load_comparison(const ReadFile& read, const std::string& where) {
  auto comparison = load<StoredComparison>(read, where, "comparison.json");
  const std::size_t results = comparison.results.size();
  const auto require_each = [&](const auto& list, const char* key) {
    if (list.size() == results) return;
    throw InputError({(std::filesystem::path(where) / "comparison.json").string()},
                     fmt::format("key '{}': found {} entries, expected one for each of the {} "
                                 "results",
                                 key, list.size(), results));
  };
  require_each(comparison.significance, "significance");
  require_each(comparison.models, "models");
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    require_each(parameter.estimates, "parameters.estimates");
    require_each(parameter.differences, "parameters.differences");
  }
  for (const StoredComparedCondition& condition : comparison.conditions)
    require_each(condition.scores, "conditions.scores");
  for (const StoredComparedMetric& metric : comparison.metrics)
    require_each(metric.against_first, "metrics.against_first");
  for (const StoredComparedRecord& record : comparison.records)
    require_each(record.in, "records.in");
  return comparison;
}

Compared load_compared_file(const std::filesystem::path& file, const std::string& name) {
  const std::string result = file.filename().string();
  return compared_of(load_json(files_in(file.parent_path()), file.parent_path().string(), result),
                     file, name);
}

std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders) {
  const std::vector<std::string> names = short_names(folders);
  std::vector<Compared> results;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const ReadFile read = files_in(folders[i]);
    for (const char* name : {"fit.json", "validation.json"}) {
      if (!read(name)) continue;
      results.push_back(load_compared_file(folders[i] / name, names[i]));
      break;
    }
    if (results.size() == i + 1) continue;
    throw InputError({folders[i].string()},
                     "found neither fit.json nor validation.json; expected the folder of a fit or "
                     "validation");
  }
  return results;
}

}  // namespace rigcal::report
