#include "diagnosis/record/leak_memo.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "common/error.hpp"

using namespace rigcal::diagnosis;
using Catch::WithinRel;

namespace {

/// share = C / (1 + C), flow = 1e-5 C, and a slope by a further parameter of C / (1 + C)^2.
SimulatedLeak leak_that_saturates(double c) {
  SimulatedLeak leak;
  leak.point = {c, c / (1.0 + c), 1e-5 * c, std::pow(1.0 + c, -2), 1e-5};
  leak.further_slope = Eigen::VectorXd::Constant(1, c * std::pow(1.0 + c, -2));
  return leak;
}

/// Counts what a memo simulates.
struct CountedLeaks {
  std::vector<double> coefficients;
  LeakMemo::Simulate simulate = [this](double c, PeriodicEffort) {
    coefficients.push_back(c);
    return leak_that_saturates(c);
  };
};

}  // namespace

TEST_CASE("LeakMemo: records of a condition that do not leak share their simulations",
          "[diagnosis]") {
  CountedLeaks counted;
  LeakMemo memo;
  const LeakAt remembered = [&](double c) { return memo.at(c, counted.simulate).point; };
  // Ten records, whose coefficients differ by noise around zero.
  for (int i = 0; i < 10; ++i) {
    const LeakCurve curve = curve_about(remembered, 0.001 * (i - 5), 0.25);
    CHECK(curve.share(0.25) == leak_that_saturates(0.25).point.share);
  }
  CHECK(counted.coefficients.size() == 2);
  // A new leak requires three more simulations, a repeated request none.
  for (int i = 0; i < 2; ++i) curve_about(remembered, 1.0, 0.25);
  CHECK(counted.coefficients.size() == 5);
}

TEST_CASE("LeakMemo: leaks that are close to each other are between few nodes", "[diagnosis]") {
  CountedLeaks counted;
  LeakMemo memo({7}, Between::interpolated);
  for (int i = -50; i <= 50; ++i) {
    const double c = 0.4 * (1.0 + 1e-3 * i);
    CAPTURE(c);
    const SimulatedLeak leak = memo.at(c, counted.simulate);
    CHECK(leak.point.coefficient == c);
    // A cubic is off by 0.03^4 / 384 of a share that saturates, a line by 0.03^2 / 4 of a slope.
    CHECK_THAT(leak.point.share, WithinRel(leak_that_saturates(c).point.share, 1e-8));
    CHECK_THAT(leak.point.leak_flow_m3_per_s, WithinRel(1e-5 * c, 1e-12));
    CHECK_THAT(leak.point.share_slope, WithinRel(leak_that_saturates(c).point.share_slope, 2.5e-4));
    CHECK_THAT(leak.further_slope(0), WithinRel(leak_that_saturates(c).further_slope(0), 2.5e-4));
  }
  CHECK(counted.coefficients.size() <= 6);
  CHECK(std::set<double>(counted.coefficients.begin(), counted.coefficients.end()).size() ==
        counted.coefficients.size());
}

TEST_CASE("LeakMemo: the order of requests changes nothing", "[diagnosis]") {
  std::vector<double> wanted{0.2, 0.21, 0.199, 0.35};
  const auto shares = [&] {
    CountedLeaks counted;
    LeakMemo memo({7}, Between::interpolated, 0.2);
    std::vector<std::pair<double, double>> found;
    for (const double c : wanted) found.emplace_back(c, memo.at(c, counted.simulate).point.share);
    std::sort(found.begin(), found.end());
    return found;
  };
  const auto forwards = shares();
  std::reverse(wanted.begin(), wanted.end());
  CHECK(shares() == forwards);
}

TEST_CASE("LeakMemo: nodes begin with the effort of a typical one", "[diagnosis]") {
  std::vector<int> periods;
  const LeakMemo::Simulate simulate = [&](double c, PeriodicEffort least) {
    periods.push_back(least.periods);
    SimulatedLeak leak = leak_that_saturates(c);
    leak.effort = {32, 512};
    return leak;
  };
  LeakMemo memo({7}, Between::interpolated, 0.5);
  memo.at(0.2, simulate);
  CHECK(periods == std::vector<int>{0, 32, 32});
}

TEST_CASE("LeakMemo: where a node cannot be simulated, the leak itself is", "[diagnosis]") {
  const LeakMemo::Simulate simulate = [](double c, PeriodicEffort) {
    if (c > 0.4) throw rigcal::NoResultError("beyond the bound");
    return leak_that_saturates(c);
  };
  LeakMemo memo({7}, Between::interpolated);
  CHECK(memo.at(0.4, simulate).point.share == leak_that_saturates(0.4).point.share);
  CHECK_THROWS_AS(memo.at(0.41, simulate), rigcal::NoResultError);
}
