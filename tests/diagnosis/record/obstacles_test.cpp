#include "diagnosis/record/obstacles.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/datasets/campaign_fixture.hpp"
#include "tests/support/small_rig.hpp"

using namespace rigcal;
using Catch::Contains;
using rigcal::test::load_text;

namespace {

const std::string kHead = R"(schema = "rigcal.campaign/1"
[rig]
model = "load_pressure"
[rig.parameters]
supply_pressure = "6.2 MPa"
mass = "60 kg"
damping = "1000 N s/m"
valve_gain = "2e-5 m/V"
leakage_coefficient = 0.3
)" + test::kSmallRig;

const std::string kChannels = R"([recording.channels]
time = { column = "t", unit = "s" }
command = { column = "u", unit = "V" }
position = { column = "x", unit = "mm" }
)";

std::string condition(const std::string& id, const std::string& more) {
  return "[[condition]]\nid = \"" + id +
         "\"\nwaveform = \"recorded\"\nuse = \"diagnose\"\nrepeats = [\"" + id + ".csv\"]\n" + more;
}

std::string all(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& each : reasons) text += each + "\n";
  return text;
}

}  // namespace

TEST_CASE("obstacles: none for records that can be compared", "[diagnosis]") {
  const datasets::Campaign campaign = load_text(kHead + kChannels + condition("a", ""));
  CHECK(diagnosis::obstacles(campaign, true).empty());
  CHECK_THAT(all(diagnosis::obstacles(campaign, false)), Contains("--fit"));
}

TEST_CASE("obstacles: everything that is missing is named at once", "[diagnosis]") {
  const datasets::Campaign campaign = load_text(R"(schema = "rigcal.campaign/1"
[rig]
model = "load_pressure"
[rig.parameters]
mass = "60 kg"
[recording.channels]
time = { column = "sample", unit = "counts" }
position = { column = "x", unit = "counts" }
)" + condition("a", ""));
  const std::string reasons = all(diagnosis::obstacles(campaign, true));
  CHECK_THAT(reasons, Contains("damping, stiffness") && Contains("of the rig is unknown"));
  CHECK_THAT(reasons, Contains("no channel command"));
  CHECK_THAT(reasons, Contains("sampling rate"));
  CHECK_THAT(reasons, Contains("position has raw counts"));
  CHECK_THAT(reasons, !Contains("mass,"));
}

TEST_CASE("obstacles: a condition that can be diagnosed is enough", "[diagnosis]") {
  const datasets::Campaign campaign =
      load_text(kHead + kChannels + condition("a", "") +
                "[[condition]]\nid = \"b\"\nwaveform = \"recorded\"\n"
                "use = \"diagnose\"\n");
  CHECK(diagnosis::obstacles(campaign, true).empty());
  const auto found = diagnosis::diagnosable(campaign);
  REQUIRE(found.conditions.size() == 1);
  CHECK(found.conditions.front()->id == "a");
  CHECK_THAT(all(found.left_out), Contains("\"b\" is left out") && Contains("no record"));
}

TEST_CASE("is_healthy: class normal, or a coefficient that is known to be 0", "[diagnosis]") {
  const auto healthy = [](const std::string& levels) {
    const datasets::Campaign campaign =
        load_text(kHead + kChannels + levels + condition("a", "leak_level = \"x\"\n"));
    return diagnosis::is_healthy(campaign, campaign.conditions.front());
  };
  const auto level = [](const std::string& value) {
    return "[leak_level.x]\nparameters = { leakage_coefficient = " + value + " }\n";
  };
  CHECK(healthy(level("0")));
  CHECK_FALSE(healthy(level("0.3")));
  CHECK_FALSE(healthy("[leak_level.x]\nparameters = { mass = \"50 kg\" }\n"));
  CHECK(healthy("[diagnosis]\nlevel_class = { x = \"normal\" }\n"));
  CHECK_FALSE(healthy("[diagnosis]\nlevel_class = { x = \"slight\" }\n" + level("0")));
  // The parameter of the campaign's law counts.
  const std::string laminar = "[diagnosis]\nleak_law = \"laminar\"\n";
  const std::string none = "[leak_level.x]\nparameters = { laminar_leakage = \"0 m3/(s Pa)\" }\n";
  CHECK(healthy(laminar + none));
  CHECK_FALSE(healthy(laminar + level("0")));
  CHECK_FALSE(healthy(none));
}

TEST_CASE("confounded: level with specimen and date, but not where both appear", "[diagnosis]") {
  const std::string levels = "[diagnosis]\nlevel_class = { none = \"normal\" }\n";
  const auto with = [&](const std::string& second_date) {
    const datasets::Campaign campaign = load_text(
        kHead + kChannels + levels +
        condition("a", "leak_level = \"none\"\nspecimen = \"one\"\ndate = 2019-09-11\n") +
        condition("b", "leak_level = \"seal\"\nspecimen = \"two\"\ndate = " + second_date + "\n"));
    return all(diagnosis::confounded(campaign));
  };
  CHECK_THAT(with("2019-09-10"), Contains("level and specimen") && Contains("level and date"));
  CHECK_THAT(with("2019-09-11"), Contains("level and specimen") && !Contains("level and date"));
}
