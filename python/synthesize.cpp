#include "datasets/synthetic/synthesize.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include "python/campaign.hpp"
#include "report/store/folder.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

fs::path synthesize(const Campaign& self, const fs::path& out, const Integer& seed,
                    const std::optional<Integer>& threads) {
  require_path("out", out);
  const std::uint64_t number =
      whole_number("seed", seed, 0, std::numeric_limits<std::uint64_t>::max());
  const int thread_number = thread_count(threads);
  const py::gil_scoped_release released;
  report::require_inputs_kept(out, {"campaign.toml"}, report::hash_inputs(self.campaign, {}));
  const report::HeldFolder held(out);
  return datasets::synthesize(self.campaign, number, out, thread_number).campaign_file;
}

}  // namespace

void bind_synthesize(CampaignClass& campaign) {
  campaign.def("synthesize", &synthesize, py::arg("out"), py::kw_only(), py::arg("seed"),
               py::arg("threads") = py::none(),
               R"(Makes records of a known rig, as `rigcal synthesize`.

Args:
    out: folder for campaign.toml, records/ and truth.json
    seed: of the noise; the same seed gives the same bytes
    threads: None: as many as the machine has

Returns:
    path of the campaign file of these records

Raises:
    InputError: the campaign has no [synthetic]
    NoResultError: a condition cannot be simulated
    WriteError: a file cannot be written)");
}

}  // namespace rigcal::python
