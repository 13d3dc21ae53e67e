#include "calib/search/basins.hpp"

#include <catch2/catch.hpp>

namespace rigcal::calib {
namespace {

using Catch::Contains;

}  // namespace

TEST_CASE("basins: starts that ended at one point, and those that did not", "[calib]") {
  const auto start = [](int number, double cost, double value, FitStatus status) {
    StartReport report;
    report.number = number;
    report.final_cost = cost;
    report.end_values = {value};
    report.status = status;
    return report;
  };
  FittedParameter parameter;
  parameter.ci95 = {0.9, 1.1};
  const std::vector<StartReport> starts{
      start(1, 50.0, 3.0, FitStatus::converged), start(2, 10.001, 1.001, FitStatus::converged),
      start(3, 10.0, 1.0, FitStatus::converged), start(4, 9.0, 1.0, FitStatus::failed)};
  const auto found = basins(starts, {parameter}, 1.0);
  REQUIRE(found.size() == 2);
  CHECK(found[0].starts == std::vector<int>{3, 2});
  CHECK(found[1].starts == std::vector<int>{1});
  const std::string words = agreement_of(starts, found, 1.0);
  CHECK_THAT(words, Contains("2 of 4 starts") && Contains("1 other minimum") &&
                        Contains("1 did not converge"));
  CHECK(agreement_of({starts[0]}, found, 1.0).empty());
  // Of one cost, but at two points: a tenth of the interval's width is 0.02.
  const auto apart = [&](double distance) {
    return basins({start(1, 10.0, 1.0, FitStatus::converged),
                   start(2, 10.0, 1.0 + distance, FitStatus::converged)},
                  {parameter}, 1.0)
        .size();
  };
  CHECK(apart(0.019) == 1);
  CHECK(apart(0.021) == 2);
  // Where the residuals are far beyond the noise so are differences of cost that mean nothing.
  const std::vector<StartReport> rough{start(1, 4e6, 1.0, FitStatus::converged),
                                       start(2, 4e6 + 9.0, 1.0, FitStatus::converged)};
  CHECK(basins(rough, {parameter}, 1.0).size() == 2);
  CHECK(basins(rough, {parameter}, 8000.0).size() == 1);
  // Nor do differences that are errors of the simulations.
  const std::vector<StartReport> even{start(1, 42865.883, 1.0, FitStatus::converged),
                                      start(2, 42865.915, 1.00001, FitStatus::converged)};
  CHECK(basins(even, {parameter}, 1.0).size() == 1);
  CHECK_THAT(agreement_of({starts[3], starts[3]}, {}, 1.0), Contains("none of 2"));
}

}  // namespace rigcal::calib
