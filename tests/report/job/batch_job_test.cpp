#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>

#include "report/job/job.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::report {
namespace {

TEST_CASE("verbs_in_process: no campaign outside the root of a batch is read", "[report][batch]") {
  const test::TemporaryFolder folder;
  const auto campaign = folder.write("lab/bench/campaign.toml", "");
  std::filesystem::create_directories(folder / "root");
  BatchRequest request;
  request.folder = folder / "lab";
  request.root = folder / "root";
  const std::atomic<bool> cancel{false};
  const JobTerms terms{"rigcal batch", {}, 1, cancel, folder / "out"};
  const VerbEnd end = verbs_in_process(request, terms).fit({"bench", campaign, "bench"});
  CHECK(end.code == ExitCode::bad_input);
  CHECK_THAT(end.error, Catch::Contains("leads out of"));
}

}  // namespace
}  // namespace rigcal::report
