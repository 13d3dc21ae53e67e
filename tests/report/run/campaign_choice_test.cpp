#include "report/run/campaign_choice.hpp"

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "tests/report/run/made_rig.hpp"

namespace rigcal::report {
namespace {

using Options = std::vector<std::pair<std::string, std::string>>;

TEST_CASE("campaign choice: values and free parameters are changed, and recorded",
          "[report][run]") {
  test::MadeRig rig;
  CampaignChoice& choice = rig.choice;
  CHECK(recorded(choice) == Options{{"set", ""}, {"free", ""}});
  choice.set = {"mass=90 kg", "density=850 kg/m3"};
  choice.free = {"mass", "damping"};
  const datasets::Campaign campaign = load(choice);
  std::vector<std::string> free;
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    const auto& spec =
        model::parameter_table(campaign.rig.plant)[static_cast<std::size_t>(setting.index)];
    if (setting.fit) free.emplace_back(spec.key);
    if (spec.key == "mass") CHECK(setting.value == 90.0);
  }
  CHECK(free == std::vector<std::string>{"mass", "damping"});
  CHECK(recorded(choice) ==
        Options{{"set", "mass=90 kg, density=850 kg/m3"}, {"free", "mass,damping"}});
}

TEST_CASE("campaign choice: an unknown name is refused", "[report][run]") {
  test::MadeRig rig;
  rig.choice.free = {"mas"};
  CHECK_THROWS_AS(load(rig.choice), UsageError);
}

}  // namespace
}  // namespace rigcal::report
