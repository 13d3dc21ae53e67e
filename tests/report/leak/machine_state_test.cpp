#include "report/leak/machine_state.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using Catch::Contains;
using diagnosis::MachineState;

namespace {

MachineState leaking() {
  MachineState state;
  state.key.leak_level = "66 %";
  for (const char* signal : {"sine", "square"}) {
    auto& member = state.members.emplace_back();
    member.condition = member.signal = signal;
    member.coefficient = 0.5;
  }
  state.members.back().coefficient = 0.52;
  state.pooled.p = 0.4;
  state.duty = "sine 0.1 Hz, 50.8 mm";
  state.leak_area_m2 = 0.5 * 4e-6;
  state.estimate.coefficient = 0.5;
  state.estimate.ci95 = {0.45, 0.55};
  state.estimate.standard_error = 0.025;
  state.estimate.share = 0.15;
  state.estimate.share_ci95 = {0.14, 0.16};
  state.estimate.leak_detected = true;
  state.estimate.probability = {0.0, 0.02, 0.98, 0.0, 0.0};
  state.estimate.most_probable = datasets::LeakClass::medium;
  state.leak_class = datasets::LeakClass::medium;
  state.limit = diagnosis::nearest_limit(state.estimate, {});
  return state;
}

}  // namespace

TEST_CASE("state_sentence: what leaks, how surely, how far from the next class", "[report]") {
  MachineState state = leaking();
  CHECK(report::state_sentence(state) ==
        "66 %: 15.00 % of the servo flow leaks (14.00 to 16.00 %) at sine 0.1 Hz, 50.8 mm: medium "
        "(probability 0.98), 5.0 percentage points above the limit of medium (10 %). 2 signals "
        "agree.");
  state.pooled.p = 1e-3;
  state.pooled.agree = false;
  CHECK_THAT(report::state_sentence(state),
             Contains("2 signals disagree (coefficients 0.5 to 0.52, p = 0.001)"));
  state.members.pop_back();
  CHECK_THAT(report::state_sentence(state), Contains("From 1 signal alone."));
  state.leak_class.reset();
  CHECK_THAT(report::state_sentence(state),
             Contains("undecided, medium with a probability of 0.98 only"));
  state.estimate.share = 0.11;
  state.estimate.share_ci95 = {0.09, 0.13};
  state.limit = diagnosis::nearest_limit(state.estimate, {});
  CHECK_THAT(report::state_sentence(state),
             Contains("interval includes the limit between slight and medium (10 %)"));
}

TEST_CASE("state_sentence: no leak, no verdict, the reference", "[report]") {
  MachineState state = leaking();
  state.estimate.leak_detected = false;
  state.estimate.share_ci95 = {0.0, 0.0004};
  CHECK_THAT(report::state_sentence(state),
             Contains("no leak is detected, less than 0.04 % of the servo flow leaks"));
  state.failure = "it did not run";
  CHECK(report::state_sentence(state) == "66 %: no verdict: it did not run.");
  state.is_reference = true;
  CHECK_THAT(report::state_sentence(state), Contains("healthy reference"));
}

TEST_CASE("machine_state: a leak below zero is incompatible, in words and without numbers",
          "[report]") {
  MachineState state = leaking();
  state.estimate.coefficient = -0.05;
  state.estimate.ci95 = {-0.06, -0.04};
  state.estimate.incompatible = true;
  state.leak_class.reset();
  CHECK_THAT(report::state_sentence(state), Contains("incompatible with the model") &&
                                                Contains("-0.05 (-0.06 to -0.04)") &&
                                                Contains("supply or valve"));
  const auto json = report::json_of(report::stored(state));
  CHECK(json["compatible_with_model"] == false);
  for (const char* key : {"leakage_coefficient", "ci95", "leak_share_percent", "leak_detected",
                          "class", "nearest_limit", "leak_area_ci95_m2"})
    CHECK(json[key].is_null());
  CHECK(json["class_probabilities"]["medium"].is_null());
}

TEST_CASE("machine_state: no share of more than the servo flow", "[report]") {
  MachineState state = leaking();
  state.estimate.share = 4.99;
  state.leak_class.reset();
  CHECK_THAT(report::state_sentence(state), Contains("more than the servo valve delivers"));
  const auto json = report::json_of(report::stored(state));
  CHECK(json["leakage_coefficient"] == 0.5);
  CHECK(json["leak_share_percent"].is_null());
  CHECK(json["nearest_limit"].is_null());
}

TEST_CASE("machine_state: numbers of a verdict, nothing without one", "[report]") {
  MachineState state = leaking();
  const report::StoredState told = report::stored(state);
  CHECK(told.leak.class_ == datasets::LeakClass::medium);
  CHECK(told.leak.leak_share_percent == 15.0);
  CHECK(told.leak_area_ci95_m2->low == Approx(0.45 * 4e-6));
  CHECK(told.nearest_limit->distance_percentage_points == Approx(5.0));
  CHECK(told.agreement->agree);
  const auto json = report::json_of(told);
  CHECK(json["class"] == "medium");  // one of the keys of the state itself
  CHECK(json["class_probabilities"]["medium"] == 0.98);
  CHECK_FALSE(json.contains("share_budget"));  // nothing is known about it
  state.estimate.budget = {{{"sine", "records", 0.025}}, 0.025, 10.0, 2.2, 0.055};
  state.estimate.share_budget = {{{"sine", "records", 0.5}}, 0.5, 10.0, 2.2, 1.1};
  const auto with_budgets = report::json_of(report::stored(state));
  CHECK(with_budgets["budget"]["combined"] == with_budgets["standard_error"]);
  CHECK(with_budgets["share_budget"]["lines"][0]["uncertainty"] == 0.5);
  state.failure = "it did not run";
  const auto failed = report::json_of(report::stored(state));
  CHECK(failed["class"].is_null());
  CHECK(failed["class_probabilities"]["medium"].is_null());
  CHECK(failed["leak_share_percent"].is_null());
  CHECK_FALSE(failed.contains("budget"));
  CHECK(failed["nearest_limit"].is_null());
  CHECK(failed["failure"] == "it did not run");
}
