#include "report/store/whole_fit.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/store/stored.hpp"

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

std::optional<StoredFit> whole_fit(const std::filesystem::path& folder,
                                   const Provenance& provenance) {
  const std::filesystem::path file = folder / "fit.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const auto fit = load<StoredFit>(files_in(folder), folder.string(), "fit.json");
    const bool ended = fit.status != calib::FitStatus::stopped;
    if (ended && same_making(fit.provenance, stored(provenance)) &&
        files_stand(folder, fit.provenance))
      return fit;
  } catch (const InputError&) {
    // Unreadable results are made again.
  }
  return std::nullopt;
}

}  // namespace rigcal::report
