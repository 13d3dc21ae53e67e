#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/error.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {
namespace {

/// Last parts of the paths, as many as it takes to tell them apart.
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

bool is_usable(const Json& result) {
  const std::string status = text_of(result, "status");
  return status == "converged" || status == "stopped";
}

bool is_of_tables(const Json& result) { return text_of(result, "of") == "published tables"; }

std::optional<double> error_of(const Json& parameter) {
  const auto standard = number_of(parameter, "standard_error");
  const auto robust = number_of(parameter, "robust_standard_error");
  if (!standard) return robust;
  return robust ? std::max(*standard, *robust) : *standard;
}

const Json* find_condition(const Json& result, const std::string& id) {
  for (const Json& condition : result.at("conditions"))
    if (text_of(condition, "id") == id) return &condition;
  return nullptr;
}

std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders) {
  const std::vector<std::string> names = short_names(folders);
  std::vector<Compared> results;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const ReadFile read = files_in(folders[i]);
    for (const char* name : {"fit.json", "validation.json"}) {
      if (!read(name)) continue;
      Json result = load_json(read, folders[i].string(), name);
      if (result.is_object() && is_of_tables(result)) result["conditions"] = Json::array();
      results.push_back({names[i], folders[i] / name, std::move(result)});
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
