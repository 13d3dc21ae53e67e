#include "calib/trust/identifiability.hpp"

#include <catch2/catch.hpp>

#include "calib/search/optimum.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinRel;

/// A mass of 100 kg. Each test sets its standard error.
struct Graded {
  Twin twin;
  std::vector<datasets::Record> records;
  Uncertainty found;
  std::optional<Problem> problem;

  explicit Graded(double standard_error) {
    twin.free("mass", 100.0, 10.0, 500.0);
    twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
    records = twin.records(20, 500.0, 1);
    problem = problem_of(twin, records);
    found.standard_error = {standard_error};
    found.robust_standard_error.resize(1);
    found.robust_freedom = {50.0};
    found.robust_quantile = {2.0};
    found.from_repeats = {false};
    found.reason.resize(1);
    found.root = Eigen::MatrixXd::Identity(1, 1);
    found.reduced_chi_square = 1.0;
    found.freedom = 1e9;  // Student's t equals the normal distribution
  }

  FittedParameter graded() const {
    Evaluation optimum;
    optimum.z = problem->start();
    OptimumCheck check;
    check.side = {BoundSide::inside};
    check.active_bound = {false};
    return describe_unknowns(*problem, optimum, check, found).at(0);
  }
};

}  // namespace

TEST_CASE("identifiability: a fifth of the value is weak, all of it nothing", "[calib]") {
  CHECK(Graded(19.0 / 1.96).graded().identifiability == Identifiability::identified);
  CHECK(Graded(21.0 / 1.96).graded().identifiability == Identifiability::weak);
  CHECK(Graded(99.0 / 1.96).graded().identifiability == Identifiability::weak);
  CHECK(Graded(101.0 / 1.96).graded().identifiability == Identifiability::not_identifiable);
}

TEST_CASE("identifiability: a lag may be absent", "[calib]") {
  const auto table = model::parameter_table(model::PlantKind::load_pressure);
  for (const char* key : {"valve_time_constant", "position_lag", "force_lag"}) {
    const auto& lag = table[static_cast<std::size_t>(Twin::index(key))];
    CAPTURE(key);
    CHECK(grade_of(lag, 1e-4, 1.1e-4, false) == Identifiability::bounded);
    CHECK(grade_of(lag, 0.0, 1.1e-4, false) == Identifiability::bounded);
    CHECK(grade_of(lag, 1e-4, 0.9e-4, false) == Identifiability::weak);
  }
}

TEST_CASE("identifiability: an interval ends where the parameter does", "[calib]") {
  const auto inside = Graded(10.0).graded().ci95.value();
  CHECK_THAT(inside.low, WithinRel(100.0 - 19.6, 1e-3));
  CHECK_THAT(inside.high, WithinRel(100.0 + 19.6, 1e-3));
  const Graded wide(1000.0);
  CHECK(wide.graded().ci95->low == wide.problem->spec(0).lower);
}

TEST_CASE("identifiability: the robust error, unless it is small and hardly known", "[calib]") {
  Graded rig(10.0);
  rig.found.robust_standard_error = {5.0};
  CHECK(rig.graded().ci95_from == IntervalSource::robust_standard_error);
  CHECK_THAT(rig.graded().ci95->high, WithinRel(110.0, 1e-12));
  CHECK(rig.graded().degrees_of_freedom == 50.0);
  rig.found.robust_freedom = {2.0};
  rig.found.freedom = 7.0;
  CHECK(rig.graded().ci95_from == IntervalSource::standard_error);
  CHECK(rig.graded().degrees_of_freedom == 7.0);
  rig.found.robust_standard_error = {15.0};
  CHECK(rig.graded().ci95_from == IntervalSource::robust_standard_error);
  // Residuals far below the stated noise carry no information about it.
  rig.found.reduced_chi_square = 0.2;
  CHECK(rig.graded().ci95_from == IntervalSource::standard_error);
}

TEST_CASE("identifiability: a wider interval replaces its own clause, wherever that stands",
          "[calib]") {
  const Graded rig(21.0 / 1.96);
  const std::string first = GENERATE("", "residuals are autocorrelated");
  const std::string last = GENERATE("", "a prior on mass_kg (5 %) would make it identifiable");
  const auto joined = [&](const std::string& second, const std::string& third) {
    std::string text;
    for (const std::string& each : {first, second, third}) {
      if (!each.empty()) text += text.empty() ? each : "; " + each;
    }
    return text;
  };
  FittedParameter parameter = rig.graded();
  CHECK(parameter.reason == "half width of the 95 % interval is 21 % of the value");
  parameter.reason = joined(parameter.reason, last);
  parameter.ci95 = {parameter.value - 50.0, parameter.value + 50.0};
  grade_widened(*rig.problem, rig.found, 0, parameter);
  CHECK(parameter.identifiability == Identifiability::weak);
  CHECK(parameter.reason == joined(last, "half width of the 95 % interval is 50 % of the value"));
}

TEST_CASE("identifiability: what rests on a known value", "[calib]") {
  Graded rig(10.0);
  const std::vector<double> z = rig.problem->start();
  const double slope = rig.problem->map.slope(0, z[0]);
  const auto rests = [&](double carried) {
    rig.found.known.names = {"supply_pressure_pa"};
    rig.found.known.response = Eigen::MatrixXd::Constant(1, 1, carried / slope);
    return rests_on_known(*rig.problem, rig.found, z, 0);
  };
  CHECK(rests(7.5));  // more than half of the variance
  CHECK_FALSE(rests(6.5));
}

}  // namespace rigcal::calib
