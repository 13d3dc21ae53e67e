#include "report/store/provenance.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "common/error.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using Catch::Contains;

TEST_CASE("hash_inputs: campaign, recordings and more, each once", "[report]") {
  const test::TemporaryFolder folder;
  datasets::Campaign campaign;
  campaign.file_state = state_of_file(folder.write("campaign.toml", "a"));
  datasets::Record one;
  one.files = {state_of_file(folder.write("1.csv", "b")),
               state_of_file(folder.write("2.csv", "c"))};
  datasets::Record other;
  other.files = {one.files.back()};
  const auto inputs = report::hash_inputs(campaign, {one, other}, {folder.write("fit.json", "d")});
  REQUIRE(inputs.size() == 4);
  CHECK(inputs[0].sha256 == sha256_of_text("a"));
  CHECK(inputs[2].path == (folder / "2.csv").string());
  CHECK(inputs[3].sha256 == sha256_of_text("d"));
}

TEST_CASE("hash_inputs: a recording that changes while it is read is refused", "[report]") {
  const test::TemporaryFolder folder;
  datasets::Campaign campaign;
  campaign.file_state = state_of_file(folder.write("campaign.toml", "a"));
  datasets::Record record;
  record.files = {state_of_file(folder.write("1.csv", "b"))};
  std::ofstream(folder / "1.csv", std::ios::app) << "c";
  CHECK_THROWS_WITH(report::hash_inputs(campaign, {record}, {}),
                    Contains("1.csv: was changed while it was read"));
  campaign.file_state.changed_ns -= 1;
  CHECK_THROWS_WITH(report::hash_inputs(campaign, {}, {}),
                    Contains("campaign.toml: was changed while it was read"));
}
