#include "diagnosis/machine/state_verdict.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using Catch::Contains;
using Catch::WithinRel;
using diagnosis::MachineState;

namespace {

/// A state before its verdict.
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
  return state;
}

MachineState judged(MachineState state, double least_probability = 0.5) {
  datasets::DiagnosisSettings settings;
  settings.least_probability = least_probability;
  give_verdict(settings, state);
  return state;
}

std::string sentence_of(const MachineState& state, double least_probability = 0.5) {
  return judged(state, least_probability).sentence;
}

}  // namespace

TEST_CASE("state_sentence: what leaks, how surely, how far from the next class", "[diagnosis]") {
  MachineState state = leaking();
  CHECK(sentence_of(state) ==
        "66 %: 15.00 % of the servo flow leaks (14.00 to 16.00 %) at sine 0.1 Hz, 50.8 mm: medium "
        "(probability 0.98), 5.0 percentage points above the limit of medium (10 %). 2 signals "
        "agree.");
  state.pooled.p = 1e-3;
  state.pooled.agree = false;
  CHECK_THAT(sentence_of(state),
             Contains("2 signals disagree (coefficients 0.5 to 0.52, p = 0.001)"));
  state.members.pop_back();
  CHECK_THAT(sentence_of(state), Contains("From 1 signal alone."));
  CHECK_THAT(sentence_of(state, 0.99),
             Contains("undecided, medium with a probability of 0.98 only"));
  state.estimate.share = 0.11;
  state.estimate.share_ci95 = {0.09, 0.13};
  CHECK_THAT(sentence_of(state),
             Contains("interval includes the limit between slight and medium (10 %)"));
  state.estimate.share = 0.103;
  state.estimate.share_ci95 = {0.102, 0.104};
  CHECK_THAT(sentence_of(state),
             Contains("within 5 % of the limit between slight and medium (10 %)"));
}

TEST_CASE("state_sentence: no leak, no verdict, the reference", "[diagnosis]") {
  MachineState state = leaking();
  state.estimate.leak_detected = false;
  state.estimate.share_ci95 = {0.0, 0.0004};
  CHECK_THAT(sentence_of(state),
             Contains("no leak is detected, less than 0.04 % of the servo flow leaks"));
  state.failure = "it did not run";
  CHECK(sentence_of(state) == "66 %: no verdict: it did not run.");
  state.is_reference = true;
  CHECK_THAT(sentence_of(state), Contains("healthy reference"));
}

TEST_CASE("give_verdict: a leak below zero is incompatible, in words and without numbers",
          "[diagnosis]") {
  MachineState state = leaking();
  state.estimate.coefficient = -0.05;
  state.estimate.ci95 = {-0.06, -0.04};
  state.estimate.incompatible = true;
  state = judged(state);
  CHECK_THAT(state.sentence, Contains("incompatible with the model") &&
                                 Contains("-0.05 (-0.06 to -0.04)") && Contains("supply or valve"));
  CHECK(state.leak.compatible_with_model == false);
  CHECK_FALSE(state.leak.leakage_coefficient);
  CHECK_FALSE(state.nearest_limit);
  CHECK_FALSE(state.leak_area_m2);
  CHECK_FALSE(state.leak_area_ci95_m2);
  CHECK_FALSE(state.agreement);
}

TEST_CASE("give_verdict: no share of more than the servo flow", "[diagnosis]") {
  MachineState state = leaking();
  state.estimate.share = 4.99;
  state = judged(state);
  CHECK_THAT(state.sentence, Contains("more than the servo valve delivers"));
  CHECK(state.leak.leakage_coefficient == 0.5);
  CHECK_FALSE(state.leak.leak_share_percent);
  CHECK_FALSE(state.nearest_limit);
}

TEST_CASE("give_verdict: numbers of a verdict, nothing without one", "[diagnosis]") {
  const MachineState state = judged(leaking());
  CHECK(state.state == "66 %");
  CHECK(state.conditions == std::vector<std::string>{"sine", "square"});
  CHECK(state.leak.class_ == datasets::LeakClass::medium);
  CHECK_THAT(state.leak_area_m2.value(), WithinRel(0.5 * 4e-6, 1e-12));
  CHECK_THAT(state.leak_area_ci95_m2->low, WithinRel(0.45 * 4e-6, 1e-12));
  CHECK_THAT(state.nearest_limit->distance_percentage_points, WithinRel(5.0, 1e-12));
  CHECK(state.agreement->p == 0.4);
  MachineState alone = leaking();
  alone.members.pop_back();
  CHECK_FALSE(judged(alone).agreement);
  MachineState negative = leaking();
  negative.estimate.coefficient = -0.01;
  negative.leak_area_m2 = -0.01 * 4e-6;
  CHECK(judged(negative).leak_area_m2 == 0.0);
  MachineState failed = leaking();
  failed.failure = "it did not run";
  failed = judged(failed);
  CHECK_FALSE(failed.leak.leakage_coefficient);
  CHECK_FALSE(failed.leak.compatible_with_model);
  CHECK_FALSE(failed.leak_area_m2);
  CHECK_FALSE(failed.nearest_limit);
  CHECK_FALSE(failed.agreement);
  CHECK(failed.conditions.size() == 2);
}

TEST_CASE("finding_of: one leak is a leak, one state without a class leaves it unclear",
          "[diagnosis]") {
  using datasets::LeakClass;
  using diagnosis::Finding;
  std::vector<MachineState> states(3);
  states[0].is_reference = true;
  CHECK(finding_of(states) == Finding::not_judged);
  states[1].leak.class_ = LeakClass::normal;
  CHECK(finding_of(states) == Finding::unclear);
  states[2].leak.class_ = LeakClass::normal;
  CHECK(finding_of(states) == Finding::no_leak);
  states[1].leak.leak_share_percent = 0.5;
  states[2].leak.leak_share_percent = 15.0;
  states[2].leak.class_ = LeakClass::medium;
  CHECK(finding_of(states) == Finding::leak);
  states[1].leak.class_.reset();
  CHECK(finding_of(states) == Finding::leak);
  // The largest leak comes first, and the reference is not among them.
  const auto judged_ones = judged_states(states);
  REQUIRE(judged_ones.size() == 2);
  CHECK(judged_ones[0] == &states[2]);
}
