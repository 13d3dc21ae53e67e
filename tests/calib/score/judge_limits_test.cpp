#include "calib/score/judge_limits.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <vector>

namespace rigcal::calib {
namespace {

using Catch::Contains;

/// Result of a check: its verdict and the used fraction of the tolerance.
struct Checked {
  Verdict verdict = Verdict::pass;
  double used = 0.0;
  bool in_guard_band = false;
  bool has_value = true;
};

ConditionScore checked_score(const std::string& id, const std::vector<Checked>& checks) {
  ConditionScore score;
  score.id = id;
  for (const Checked& each : checks) {
    LimitCheck check;
    check.metric = "rho2";
    check.verdict = each.verdict;
    check.tolerance_used = each.used;
    check.in_guard_band = each.in_guard_band;
    if (each.has_value) check.value = 0.5;
    score.limit_checks.push_back(check);
    score.verdict = std::max(score.verdict.value_or(Verdict::pass), each.verdict);
    if (each.verdict != Verdict::pass) score.reasons.push_back("why of " + id);
  }
  return score;
}

std::vector<Reason> judged(const std::vector<ConditionScore>& scores) {
  std::vector<const ConditionScore*> pointers;
  for (const ConditionScore& each : scores) pointers.push_back(&each);
  std::vector<Reason> reasons;
  judge_limits(pointers, reasons);
  return reasons;
}

/// Returns "code of subject" for each reason.
std::vector<std::string> codes(const std::vector<Reason>& reasons) {
  std::vector<std::string> list;
  for (const Reason& each : reasons) list.push_back(each.code + " of " + each.subject.value_or(""));
  return list;
}

double number(const Reason& reason, const std::string& name) {
  for (const auto& [key, value] : reason.numbers)
    if (key == name) return value;
  FAIL("no number " << name);
  return 0.0;
}

}  // namespace

TEST_CASE("judge_limits: of those that meet their limits the closest is named", "[calib]") {
  const auto reasons = judged(
      {checked_score("low", {{Verdict::pass, 0.2}}),
       checked_score("high", {{Verdict::pass, 0.1}, {Verdict::pass, 0.6}, {Verdict::pass, 0.3}}),
       checked_score("mid", {{Verdict::pass, 0.4}})});
  REQUIRE(codes(reasons) == std::vector<std::string>{"limits_kept of high"});
  CHECK(reasons[0].state == AspectState::pass);
  CHECK(number(reasons[0], "conditions") == 3.0);
  CHECK(number(reasons[0], "kept") == 3.0);
  CHECK(number(reasons[0], "tolerance_used") == 0.6);
  CHECK_THAT(reasons[0].words, Contains("3 of 3 conditions meet their limits") &&
                                   Contains("high") && Contains("60 %"));
}

TEST_CASE("judge_limits: the tolerance used in percent, and where it is no use to count",
          "[calib]") {
  const std::map<double, std::string> texts{
      {0.0, " 0 % of the tolerance"},         {0.0182, " 1.8 % of the tolerance"},
      {0.37, " 37 % of the tolerance"},       {1.0, " 100 % of the tolerance"},
      {1.7, " 170 % of the tolerance"},       {10.0, " 1000 % of the tolerance"},
      {10.1, " over 1000 % of the tolerance"}};
  for (const auto& [used, text] : texts) {
    CAPTURE(used);
    const auto reasons = judged({checked_score("one", {{Verdict::pass, used}})});
    REQUIRE(codes(reasons) == std::vector<std::string>{"limits_kept of one"});
    CHECK_THAT(reasons[0].words, Contains("one meets its limits:" + text));
    CHECK(number(reasons[0], "tolerance_used") == used);
    CHECK(number(reasons[0], "conditions") == 1.0);
  }
}

TEST_CASE("judge_limits: those that break limits come first, the furthest beyond before others",
          "[calib]") {
  ConditionScore broken = checked_score("not simulated", {});
  broken.failure = "too many steps";
  broken.verdict = Verdict::fail;
  broken.reasons = {"could not be simulated: too many steps"};
  const auto reasons =
      judged({checked_score("kept", {{Verdict::pass, 0.5}}),
              checked_score("warned", {{Verdict::warn, 0.9}}),
              checked_score("beyond", {{Verdict::fail, 1.2}}), broken,
              checked_score("also kept", {{Verdict::pass, 0.7}}),
              checked_score("far beyond", {{Verdict::pass, 0.1}, {Verdict::fail, 3.0}})});
  CHECK(codes(reasons) == std::vector<std::string>{"not_simulated of not simulated",
                                                   "limit_broken of far beyond",
                                                   "limit_broken of beyond", "limit_near of warned",
                                                   "limits_kept of also kept"});
  CHECK(reasons[0].state == AspectState::fail);
  CHECK_THAT(reasons[0].words, Contains("not simulated: could not be simulated: too many steps"));
  CHECK(reasons[1].state == AspectState::fail);
  CHECK(number(reasons[1], "tolerance_used") == 3.0);
  CHECK_THAT(reasons[1].words, Contains("far beyond: why of far beyond"));
  CHECK(reasons[3].state == AspectState::reservation);
  CHECK(number(reasons[3], "tolerance_used") == 0.9);
  CHECK(number(reasons[4], "kept") == 2.0);
  CHECK(number(reasons[4], "conditions") == 6.0);
  CHECK(number(reasons[4], "tolerance_used") == 0.7);
  CHECK_THAT(reasons[4].words, Contains("2 of 6 conditions"));
}

TEST_CASE("judge_limits: the guard band is named where nothing else warns", "[calib]") {
  const auto code = [](const std::vector<Checked>& checks) {
    const auto reasons = judged({checked_score("one", checks)});
    REQUIRE(reasons.size() == 1);
    CHECK(reasons[0].state == AspectState::reservation);
    return reasons[0].code;
  };
  const Checked guarded{Verdict::warn, 0.9, true};
  const Checked near{Verdict::warn, 0.9, false};
  const Checked kept{Verdict::pass, 0.1, false};
  CHECK(code({guarded}) == "guard_band");
  CHECK(code({kept, guarded}) == "guard_band");
  CHECK(code({guarded, kept}) == "guard_band");
  CHECK(code({near}) == "limit_near");
  CHECK(code({guarded, near}) == "limit_near");
  CHECK(code({near, guarded}) == "limit_near");
}

TEST_CASE("judge_limits: a limit that cannot be evaluated is not called broken", "[calib]") {
  const auto code = [](const std::vector<Checked>& checks) {
    const auto reasons = judged({checked_score("one", checks)});
    REQUIRE(reasons.size() == 1);
    CHECK(reasons[0].state == AspectState::fail);
    return reasons[0].code;
  };
  CHECK(code({{Verdict::fail, 2.0}}) == "limit_broken");
  CHECK(code({{Verdict::fail, 0.0, false, false}}) == "limit_not_evaluable");
  CHECK(code({{Verdict::pass, 0.5}, {Verdict::fail, 0.0, false, false}}) == "limit_not_evaluable");
}

TEST_CASE("judge_limits: what was not scored, or has no limit, keeps none", "[calib]") {
  ConditionScore stopped = checked_score("stopped", {});
  stopped.not_scored = "stopped on request";
  const auto reasons = judged({stopped, checked_score("no limit", {})});
  REQUIRE(codes(reasons) == std::vector<std::string>{"not_scored of stopped"});
  CHECK(reasons[0].state == AspectState::reservation);
  CHECK_THAT(reasons[0].words, Contains("not scored (stopped on request)"));
  CHECK(judged({}).empty());
  CHECK(judged({checked_score("no limit", {})}).empty());
}

TEST_CASE("judge_limits: conditions are counted in words", "[calib]") {
  CHECK(conditions_text(0) == "0 conditions");
  CHECK(conditions_text(1) == "1 condition");
  CHECK(conditions_text(2) == "2 conditions");
}

TEST_CASE("judge_limits: limits are those of the campaign or of a condition of its own",
          "[calib]") {
  datasets::Campaign campaign;
  Fit fit;
  CHECK_FALSE(has_limits(campaign, fit));
  fit.conditions.push_back(checked_score("none", {}));
  CHECK_FALSE(has_limits(campaign, fit));
  fit.conditions.push_back(checked_score("own", {{Verdict::pass, 0.1}}));
  CHECK(has_limits(campaign, fit));
  fit.conditions.clear();
  campaign.acceptance.push_back({datasets::Channel::position, "rho2", 0.9, std::nullopt});
  CHECK(has_limits(campaign, fit));
  CHECK(no_limits().state == AspectState::not_assessed);
  CHECK(no_limits().code == "no_limits");
}

}  // namespace rigcal::calib
