#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include "python/campaign.hpp"
#include "python/result.hpp"
#include "report/run/synthesis.hpp"
#include "report/store/folder.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

fs::path synthesize(const Campaign& self, const fs::path& out, const Integer& seed,
                    const std::optional<Integer>& threads, bool force) {
  require_path("out", out);
  const std::uint64_t number =
      whole_number("seed", seed, 0, std::numeric_limits<std::uint64_t>::max());
  const int thread_number = thread_count(threads);
  const py::gil_scoped_release released;
  report::HeldFolder held(out, holding("synthesize", force));
  return report::write_synthesis(held, self.campaign, number, thread_number).campaign_file;
}

}  // namespace

void bind_synthesize(CampaignClass& campaign) {
  campaign.def("synthesize", &synthesize, py::arg("out"), py::kw_only(), py::arg("seed"),
               py::arg("threads") = py::none(), py::arg("force") = false,
               R"(Makes records of a known rig, as `rigcal synthesize`.

Args:
    out: folder for campaign.toml, records/ and truth.json
    seed: of the noise; the same seed gives the same bytes
    threads: None: as many as the machine has
    force: replace files that rigcal did not write, or that were changed since

Returns:
    path of the campaign file of these records

Raises:
    InputError: the campaign has no [synthetic]
    NoResultError: a condition cannot be simulated
    UsageError: a file that rigcal did not write would be replaced
    WriteError: a file cannot be written)");
}

}  // namespace rigcal::python
