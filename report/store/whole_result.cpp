#include "report/store/whole_result.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/store/read_json.hpp"
#include "report/store/stored_provenance.hpp"

namespace rigcal::report {
namespace {

/// Whether both were made from the same; paths may differ, as where the folder was moved.
bool same_making(const StoredProvenance& a, const StoredProvenance& b) {
  return a.version == b.version && a.revision == b.revision && a.seed == b.seed &&
         a.options == b.options &&
         std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(),
                    [](const auto& x, const auto& y) { return x.sha256 == y.sha256; });
}

bool files_stand(const std::filesystem::path& folder, const StoredProvenance& provenance) {
  return provenance.files &&
         std::all_of(provenance.files->begin(), provenance.files->end(), [&](const auto& file) {
           return sha256_of_file(folder / file.path) == file.sha256;
         });
}

}  // namespace

std::optional<Json> whole_result(const std::filesystem::path& folder, const std::string& name,
                                 const Provenance& provenance) {
  const std::filesystem::path file = folder / name;
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    Json result = read_json(file, "a result");
    const JsonNode root(result, file.string(), "", name);
    const std::string status = root["status"].string();
    StoredProvenance made;
    read_into(root["provenance"], made);
    const bool ended = status == "converged" || status == "failed";
    if (ended && same_making(made, stored(provenance)) && files_stand(folder, made)) return result;
  } catch (const InputError&) {
    // What cannot be read is made anew.
  }
  return std::nullopt;
}

}  // namespace rigcal::report
