#include "diagnosis/record/healthy_effects.hpp"

#include <catch2/catch.hpp>

#include "tests/diagnosis/healthy_sine.hpp"

using namespace rigcal;

TEST_CASE("HealthyEffects: only conditions that are simulated alike share", "[diagnosis]") {
  const test::HealthySine made = test::healthy_sine(0.3);
  const std::vector<datasets::Record> records{made.record};
  const datasets::Condition& condition = made.campaign.conditions.front();
  const calib::Problem problem =
      calib::make_problem(made.campaign, records, {&condition}, true, nullptr);
  const calib::ProblemCondition& prepared = problem.conditions.front();
  calib::Effect effect;
  effect.about.key = "valve_lag";
  effect.about.size = 1e-4;

  diagnosis::HealthyEffects effects;
  int simulated = 0;
  const auto ask = [&](const calib::ProblemCondition& at, const model::ParameterValues& values,
                       const calib::Effect& acting) {
    return effects.of(at, values, {acting}, [&] {
      ++simulated;
      return calib::EffectChanges{Eigen::MatrixXd::Constant(1, 1, simulated)};
    });
  };
  const auto first = ask(prepared, prepared.values, effect);
  CHECK(simulated == 1);

  // Another leak opening of the same signal, with another noise.
  datasets::Condition opened = condition;
  opened.id = "opened";
  opened.leak_level = "100";
  calib::ProblemCondition alike = prepared;
  alike.condition = &opened;
  alike.channels.front().sd *= 2.0;
  CHECK(ask(alike, prepared.values, effect) == first);
  CHECK(simulated == 1);

  const auto differs = [&](const calib::ProblemCondition& at, const model::ParameterValues& values,
                           const calib::Effect& acting) {
    const int before = simulated;
    const bool is_new = ask(at, values, acting) != first;
    return is_new && simulated == before + 1;
  };
  opened.amplitude = 2.0 * condition.amplitude.value();
  CHECK(differs(alike, prepared.values, effect));
  model::ParameterValues heavier = prepared.values;
  heavier.set("mass", 2.0 * heavier["mass"]);
  CHECK(differs(prepared, heavier, effect));
  calib::Effect larger = effect;
  larger.secant = 2.0;
  CHECK(differs(prepared, prepared.values, larger));
  calib::ProblemCondition given = prepared;
  given.rig.initial = prepared.rig.initial == model::InitialState::rest ? model::InitialState::given
                                                                        : model::InitialState::rest;
  CHECK(differs(given, prepared.values, effect));
  datasets::Record shorter = made.record;
  shorter.time_s.pop_back();
  calib::ProblemCondition cut = prepared;
  cut.record = &shorter;
  CHECK(differs(cut, prepared.values, effect));
}

TEST_CASE("HealthyEffects: a recorded input belongs to its record", "[diagnosis]") {
  const test::HealthySine made = test::healthy_sine(0.3);
  const std::vector<datasets::Record> records{made.record};
  calib::Problem problem = calib::make_problem(made.campaign, records,
                                               {&made.campaign.conditions.front()}, true, nullptr);
  calib::ProblemCondition& prepared = problem.conditions.front();
  prepared.inputs.external_load =
      model::Signal::held(made.record.time_s, std::vector<double>(made.record.time_s.size()));
  diagnosis::HealthyEffects effects;
  int simulated = 0;
  for (int i = 0; i < 2; ++i)
    effects.of(prepared, prepared.values, {}, [&] {
      ++simulated;
      return calib::EffectChanges{};
    });
  CHECK(simulated == 2);
}
