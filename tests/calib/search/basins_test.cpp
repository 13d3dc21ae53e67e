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
      start(3, 10.0, 1.0, FitStatus::converged), start(4, 11.0, 1.0, FitStatus::failed)};
  const auto found = basins(starts, {parameter}, 1.0);
  REQUIRE(found.size() == 2);
  CHECK(found[0].starts == std::vector<int>{3, 2});
  CHECK(found[1].starts == std::vector<int>{1});
  const std::string words = agreement_of(starts, found, 1.0);
  CHECK_THAT(words, Contains("2 of 4 starts") && Contains("1 other minimum") &&
                        Contains("1 did not converge"));
  CHECK(agreement_of({starts[0]}, found, 1.0).empty());
  // A start that did not converge has a lower cost, so no converged start is the best.
  std::vector<StartReport> beneath = starts;
  beneath[3].final_cost = 9.0;
  const std::string told = agreement_of(beneath, found, 1.0);
  CHECK_THAT(told, Contains("start 4 of 4") && Contains("did not converge") && Contains("by 1 "));
  // A start without any point has no cost, either.
  beneath[3].final_cost = 0.0;
  beneath[3].end_values.clear();
  CHECK(agreement_of(beneath, found, 1.0) == words);
  // The two points have equal cost. A tenth of the interval width is 0.02.
  const auto apart = [&](double distance) {
    return basins({start(1, 10.0, 1.0, FitStatus::converged),
                   start(2, 10.0, 1.0 + distance, FitStatus::converged)},
                  {parameter}, 1.0)
        .size();
  };
  CHECK(apart(0.019) == 1);
  CHECK(apart(0.021) == 2);
  // If the residuals are far above the noise, larger differences in cost are also insignificant.
  const std::vector<StartReport> rough{start(1, 4e6, 1.0, FitStatus::converged),
                                       start(2, 4e6 + 9.0, 1.0, FitStatus::converged)};
  CHECK(basins(rough, {parameter}, 1.0).size() == 2);
  CHECK(basins(rough, {parameter}, 8000.0).size() == 1);
  // Differences due to simulation errors are insignificant, too.
  const std::vector<StartReport> even{start(1, 42865.883, 1.0, FitStatus::converged),
                                      start(2, 42865.915, 1.00001, FitStatus::converged)};
  CHECK(basins(even, {parameter}, 1.0).size() == 1);
  CHECK_THAT(agreement_of({starts[3], starts[3]}, {}, 1.0), Contains("none of 2"));
}

TEST_CASE("basins: the start of lower cost is better, whatever ended it", "[calib]") {
  const auto start = [](double cost, FitStatus status) {
    StartReport report;
    report.final_cost = cost;
    report.status = status;
    return report;
  };
  const StartReport converged = start(34875.0, FitStatus::converged);
  for (const FitStatus status : {FitStatus::stopped, FitStatus::failed}) {
    const StartReport lower = start(30249.0, status);
    CHECK(better_start(lower, converged, 17.9));
    CHECK_FALSE(better_start(converged, lower, 17.9));
    // The difference is below 0.02 variances (0.358). The costs count as equal, so the converged
    // start wins.
    const StartReport beneath = start(34875.0 - 0.35, status);
    CHECK(better_start(converged, beneath, 17.9));
    CHECK_FALSE(better_start(beneath, converged, 17.9));
    CHECK(better_start(start(34875.0 - 0.37, status), converged, 17.9));
  }
  CHECK(better_start(start(1.0, FitStatus::converged), start(1.001, FitStatus::converged), 1.0));
}

}  // namespace rigcal::calib
