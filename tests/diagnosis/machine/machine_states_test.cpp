#include "diagnosis/machine/machine_states.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "diagnosis/record/signal_name.hpp"
#include "tests/diagnosis/healthy_sine.hpp"

using namespace rigcal;
using Catch::Contains;
using Catch::WithinRel;
using diagnosis::MachineState;
using diagnosis::RecordDiagnosis;

namespace {

/// Sines of 1 Hz and 0.5 Hz at one leak level.
struct TwoSines {
  test::HealthySine made = test::healthy_sine(0.3);
  std::array<datasets::RepeatRecords, 2> records;
  std::vector<RecordDiagnosis> found;

  TwoSines() {
    made.campaign.conditions.push_back(made.campaign.conditions.front());
    made.campaign.conditions[0].id = "fast";
    made.campaign.conditions[1].id = "slow";
    made.campaign.conditions[1].frequency_hz = 0.5;
    for (std::size_t i = 0; i < records.size(); ++i) {
      records[i].average = made.record;
      records[i].average.condition = made.campaign.conditions[i].id;
    }
    for (const datasets::Condition& condition : made.campaign.conditions) {
      RecordDiagnosis& record = found.emplace_back();
      record.condition = condition.id;
      record.signal = diagnosis::signal_name(made.campaign, condition);
      record.fit.coefficient = 0.3;
      record.fit.white_se = 0.01;
      record.fit.white_freedom = 100;
      record.fit.noise_se = 0.01;
      record.fit.rig_moves = Eigen::VectorXd::Zero(1);
    }
  }

  std::vector<MachineState> states() const {
    const diagnosis::RigFit rig = test::rig_of(made.campaign);
    const diagnosis::LeakProblem problem(made.campaign, rig);
    std::vector<diagnosis::Prepared> prepared;
    for (std::size_t i = 0; i < records.size(); ++i) {
      diagnosis::Prepared& each = prepared.emplace_back();
      each.condition = &problem.campaign.conditions[i];
      each.records = &records[i];
      each.scan = {0.3, 1.0};
      each.leaks = each.memo(rig.indices);
    }
    return diagnosis::machine_states(problem, rig, prepared, found, {});
  }

  MachineState only_state() const {
    const auto all = states();
    REQUIRE(all.size() == 1);
    return all.front();
  }
};

}  // namespace

TEST_CASE("machine_states: one state of all signals, at the slowest sine", "[diagnosis]") {
  const TwoSines scene;
  const MachineState state = scene.only_state();
  REQUIRE(state.ok());
  CHECK(state.members.size() == 2);
  CHECK(state.duty == scene.found[1].signal);
  CHECK_THAT(state.pooled.coefficient, WithinRel(0.3, 1e-12));
  CHECK_THAT(state.leak_area_m2.value(), WithinRel(0.3 * 4.456e-6, 1e-9));
  CHECK(state.share_slope > 0.0);
  CHECK(state.conditions == std::vector<std::string>{"fast", "slow"});
  CHECK(state.leak.leakage_coefficient == state.pooled.coefficient);
  CHECK(state.leak.class_ == state.estimate.most_probable);
  CHECK_THAT(state.sentence, Contains("2 signals agree"));
}

TEST_CASE("machine_states: a disagreement of members widens the share by theirs only",
          "[diagnosis]") {
  TwoSines scene;
  for (RecordDiagnosis& each : scene.found) each.fit.white_se = 0.001;
  const MachineState agreed = scene.only_state();
  // Two standard errors below and above their mean: their own error is widened by the root of 8.
  scene.found[0].fit.coefficient -= 0.002;
  scene.found[1].fit.coefficient += 0.002;
  const MachineState torn = scene.only_state();
  CHECK(agreed.pooled.widened == 1.0);
  CHECK_THAT(torn.pooled.widened, WithinRel(std::sqrt(8.0), 1e-9));
  // The error of the valve gain changes the share at the duty, whatever the members say.
  const auto contribution = [](const MachineState& state, const std::string& kind) {
    double squares = 0.0;
    for (const calib::BudgetLine& line : state.estimate.share_budget.lines)
      if ((line.kind == "records") == (kind == "records"))
        squares += line.uncertainty * line.uncertainty;
    return std::sqrt(squares);
  };
  CHECK(contribution(agreed, "rig") > 0.0);
  CHECK_THAT(contribution(torn, "rig"), WithinRel(contribution(agreed, "rig"), 1e-3));
  CHECK_THAT(contribution(torn, "records"),
             WithinRel(std::sqrt(8.0) * contribution(agreed, "records"), 1e-3));
}

TEST_CASE("machine_states: the campaign's duty", "[diagnosis]") {
  TwoSines scene;
  const double slow = scene.only_state().estimate.share;
  scene.made.campaign.diagnosis.duty = "fast";
  const MachineState state = scene.only_state();
  CHECK(state.duty == scene.found[0].signal);
  CHECK(state.estimate.share < slow);
  scene.made.campaign.diagnosis.duty = "fats";
  CHECK_THROWS_WITH(scene.states(), Contains("diagnosis.duty") && Contains("fats"));
}

TEST_CASE("machine_states: what is no member, and why", "[diagnosis]") {
  TwoSines scene;
  scene.found[0].is_reference = true;
  MachineState state = scene.only_state();
  CHECK(state.ok());
  REQUIRE(state.members.size() == 1);
  CHECK(state.members.front().condition == "slow");
  REQUIRE(state.left_out.size() == 1);
  CHECK_THAT(state.left_out.front(), Contains("fast: the healthy reference"));
  scene.found[0].is_reference = false;
  scene.found[0].explained_by_leak = false;
  state = scene.only_state();
  CHECK(state.members.size() == 1);
  CHECK_THAT(state.left_out.front(), Contains("fast: not explained by a leak"));
  scene.found[0].explained_by_leak.reset();
  scene.found[0].fit.failure = "too short";
  CHECK_THAT(scene.only_state().left_out.front(), Contains("fast: too short"));
  scene.found[1].is_reference = true;
  scene.found[0].fit.failure.clear();
  scene.found[0].is_reference = true;
  state = scene.only_state();
  CHECK(state.is_reference);
  CHECK_FALSE(state.ok());
}

TEST_CASE("machine_states: a class that is not probable enough is none", "[diagnosis]") {
  TwoSines scene;
  scene.made.campaign.diagnosis.least_probability = 1.0 + 1e-9;
  const MachineState state = scene.only_state();
  CHECK(state.ok());
  CHECK_FALSE(state.leak.class_);
}
