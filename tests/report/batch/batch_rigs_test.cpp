#include "report/batch/batch_rigs.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace rigcal::report {
namespace {

/// One rig whose verbs end as a test says.
struct ScriptedRig {
  test::TemporaryFolder folder;
  BatchRig rig{"bench", "bench/campaign.toml", "bench"};
  std::atomic<bool> cancel{false};
  std::optional<VerbEnd> diagnosis;  ///< none if no diagnosis is requested

  void write_result(const std::string& text) const { folder.write("bench/fit.json", text); }

  /// @param writes  content of the result; std::nullopt if the fit writes none
  RigEnd end(ExitCode code, const std::optional<std::string>& writes,
             const std::string& error = {}) const {
    RigVerbs verbs;
    verbs.fit = [&](const BatchRig& fitted) -> VerbEnd {
      CHECK(fitted.rig == "bench");
      if (writes) write_result(*writes);
      return {code, error, 2.0};
    };
    if (diagnosis) verbs.diagnose = [&](const BatchRig&) { return *diagnosis; };
    return run_rig(rig, folder.path(), verbs, cancel);
  }
};

TEST_CASE("run_rig: a fit that ends leaves its result, whatever its verdict", "[report][batch]") {
  for (const ExitCode code : {ExitCode::done, ExitCode::verdict_fail, ExitCode::no_result}) {
    const ScriptedRig scripted;
    const RigEnd made = scripted.end(code, "made");
    CHECK(made.code == code);
    CHECK(made.left_result);
    CHECK_FALSE(made.unchanged);
    const RigEnd again = scripted.end(code, std::nullopt);
    CHECK(again.left_result);
    CHECK(again.unchanged);
  }
}

TEST_CASE("run_rig: a result of an earlier run is none of this one", "[report][batch]") {
  const ScriptedRig scripted;
  scripted.write_result("earlier");
  for (const ExitCode code : {ExitCode::bad_input, ExitCode::stopped, ExitCode::internal}) {
    const RigEnd end = scripted.end(code, std::nullopt, "refused");
    CHECK(end.code == code);
    CHECK(end.error == "refused");
    CHECK_FALSE(end.left_result);
    CHECK_FALSE(end.unchanged);
  }
  // What a stopped fit has reached is a result, if it came to write one.
  const RigEnd stopped = scripted.end(ExitCode::stopped, "reached");
  CHECK(stopped.left_result);
  CHECK_FALSE(stopped.unchanged);
}

TEST_CASE("run_rig: the graver end counts, and a diagnosis is told as such", "[report][batch]") {
  ScriptedRig scripted;
  scripted.diagnosis = VerbEnd{ExitCode::done, "", 3.0};
  const RigEnd diagnosed = scripted.end(ExitCode::verdict_fail, "made");
  CHECK(diagnosed.code == ExitCode::verdict_fail);
  CHECK(diagnosed.error.empty());
  CHECK(diagnosed.seconds == 5.0);

  scripted.diagnosis = VerbEnd{ExitCode::no_result, "no leak level", 3.0};
  const RigEnd refused = scripted.end(ExitCode::done, "made again");
  CHECK(refused.code == ExitCode::no_result);
  CHECK(refused.error == "diagnose: no leak level");
  CHECK(refused.left_result);

  // Without a usable fit there is nothing to diagnose by.
  const RigEnd unusable = scripted.end(ExitCode::no_result, "failed", "no minimum");
  CHECK(unusable.error == "no minimum");
  CHECK(unusable.seconds == 2.0);
}

TEST_CASE("run_rig: after a signal no rig begins", "[report][batch]") {
  ScriptedRig scripted;
  scripted.write_result("earlier");
  scripted.cancel = true;
  const RigEnd end = scripted.end(ExitCode::done, "made");
  CHECK(end.code == ExitCode::stopped);
  CHECK(end.error.find("not started") == 0);
  CHECK_FALSE(end.left_result);
  CHECK(test::text_of(scripted.folder / "bench/fit.json") == "earlier");
}

TEST_CASE("run_rig: after a signal during the fit no diagnosis begins", "[report][batch]") {
  ScriptedRig scripted;
  bool diagnosed = false;
  RigVerbs verbs;
  verbs.fit = [&](const BatchRig&) -> VerbEnd {
    scripted.cancel = true;
    return {ExitCode::done, "", 2.0};
  };
  verbs.diagnose = [&](const BatchRig&) -> VerbEnd {
    diagnosed = true;
    return {};
  };
  const RigEnd end = run_rig(scripted.rig, scripted.folder.path(), verbs, scripted.cancel);
  CHECK_FALSE(diagnosed);
  CHECK(end.code == ExitCode::done);
}

TEST_CASE("rig_end_of: as it went", "[report][batch]") {
  const RigEnd end = rig_end_of(bytes_of({ExitCode::verdict_fail, true, false, 1.25, "why \xff"}));
  CHECK(end.code == ExitCode::verdict_fail);
  CHECK(end.left_result);
  CHECK_FALSE(end.unchanged);
  CHECK(end.seconds == 1.25);
  CHECK(end.error.substr(0, 4) == "why ");  // bytes of no character are replaced
}

TEST_CASE("find_rigs: by the order of their folders, but for those among the results",
          "[report][batch]") {
  const test::TemporaryFolder folder;
  for (const char* each : {"b/", "a/", "out/a/", "out/a/deep/", ""})
    folder.write(std::string("lab/") + each + "campaign.toml", "");
  std::vector<std::string> rigs;
  for (const BatchRig& rig : find_rigs(folder / "lab", folder / "lab/out")) rigs.push_back(rig.rig);
  CHECK(rigs == std::vector<std::string>{"a", "b", "lab"});
}

TEST_CASE("find_rigs: two rigs of one name would write into one folder", "[report][batch]") {
  const test::TemporaryFolder folder;
  folder.write("lab/campaign.toml", "");  // takes the name of the folder
  folder.write("lab/lab/campaign.toml", "");
  CHECK_THROWS_WITH(find_rigs(folder / "lab", folder / "out"),
                    Catch::Contains("would go to the same folder lab"));
}

}  // namespace
}  // namespace rigcal::report
