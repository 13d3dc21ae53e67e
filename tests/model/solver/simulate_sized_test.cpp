#include "model/solver/simulate_sized.hpp"

#include <catch2/catch.hpp>

#include "model/plant/load_pressure.hpp"
#include "model/plant/two_chamber.hpp"
#include "tests/model/rig.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;

namespace {

/// As many parameters as fit into one pass.
constexpr const char* kFree[] = {"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"};

/// Simulates as simulate() would on a processor without AVX2.
template <typename Plant, int N>
Simulation by_base(const Experiment& e) {
  const Layout layout = layout_of(e.rig, e.values, e.free, Plant::kStates);
  const auto samples = static_cast<Eigen::Index>(e.times_s.size());
  const auto columns = static_cast<Eigen::Index>(e.free.size());
  Simulation result;
  result.outputs.resize(samples, static_cast<Eigen::Index>(e.outputs.size()));
  result.sensitivities.assign(e.outputs.size(), Eigen::MatrixXd(samples, columns));
  simulate_sized<Plant, N, InstructionSet::base>(
      {layout, e.rig.initial, e.rig.before, e.values, e.free, e.inputs, e.times_s, e.outputs,
       e.options, std::nullopt, std::chrono::steady_clock::now()},
      result);
  return result;
}

template <typename Plant, int N>
void check_same(Experiment e) {
  e.options.periodic_steady_state = false;
  // Because of rounding, the two may take different steps. At this tolerance both are accurate
  // enough to be compared.
  e.options.tolerance = 1e-11;
  for (const char* key : kFree) e.free.push_back(parameter_index(e.values.plant, key));
  const Simulation here = e();
  const Simulation there = by_base<Plant, N>(e);
  REQUIRE(here.ok());
  REQUIRE(there.ok());
  CHECK(difference(here.outputs, there.outputs) < 1e-8);
  for (std::size_t k = 0; k < e.outputs.size(); ++k)
    CHECK(difference(here.sensitivities[k], there.sensitivities[k]) < 1e-6);
}

}  // namespace

TEST_CASE("simulate_sized: old processors compute the same, with room for more states", "[model]") {
  check_same<LoadPressurePlant, 10>({});
  check_same<TwoChamberPlant, 12>(two_chamber_rig());
}
