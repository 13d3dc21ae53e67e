#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::kExample;
using rigcal::test::replaced;
using rigcal::test::TemporaryFolder;

TEST_CASE("repeat_sources: a pattern looks through so many files at most", "[datasets]") {
  const TemporaryFolder folder;
  constexpr int kEach = 460;  // its square exceeds 200 000
  for (int i = 0; i < kEach; ++i) folder.write("many/" + std::to_string(i) + ".csv", "t\n");
  std::filesystem::create_directories(folder / "links");
  const auto load = [&](const std::string& pattern) {
    return load_campaign(
        folder.write("campaign.toml", replaced(kExample, "records/sine_0.1Hz_33_*.csv", pattern)));
  };
  for (int i = 0; i < kEach; ++i)
    std::filesystem::create_directory_symlink(folder / "many",
                                              folder / "links" / std::to_string(i));
  const Campaign few = load("links/7/*.csv");
  CHECK(repeat_sources(few, few.conditions[0]).size() == kEach);
  const Campaign all = load("links/*/*.csv");
  CHECK_THROWS_WITH(repeat_sources(all, all.conditions[0]),
                    Catch::Contains("links/*/*.csv") && Catch::Contains("more than 200000"));
}
