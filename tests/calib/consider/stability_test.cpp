#include "calib/consider/stability.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "calib/fit.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

/// Returns how many estimates differ if the validation record was made with another supply.
///
/// @param of_supply  relative difference of the supply
/// @param date       date of the validation record; the fitted record has 2026-03-01
long unstable(double of_supply, const char* date) {
  Twin twin = one_square();
  twin.add("again", datasets::Waveform::square, 3.0, 0.012, {}, datasets::Use::validate);
  twin.campaign.conditions[0].date = "2026-03-01";
  twin.campaign.conditions[1].date = date;
  twin.noise_sd_m = 1e-5;
  twin.campaign.considered.none = true;  // effects would widen the errors
  twin.offsets["again"] = {Twin::index("supply_pressure"),
                           (1.0 + of_supply) * twin.setting("supply_pressure").value};
  const Fit found = fit(twin.campaign, twin.records(1000, 500.0, 1), {});
  REQUIRE(found.status == FitStatus::converged);
  const std::vector<StabilityCheck>& checks = found.stability.value();
  REQUIRE(checks.size() == 2);
  return std::count_if(checks.begin(), checks.end(),
                       [](const StabilityCheck& each) { return each.differs; });
}

}  // namespace

TEST_CASE("stability: estimates may differ by what differs from day to day", "[calib]") {
  // The usual standard deviation of the supply is 0.5 %.
  CHECK(unstable(0.0, "2026-03-01") == 0);
  CHECK(unstable(0.008, "2026-03-01") > 0);
  CHECK(unstable(0.008, "2026-03-09") == 0);
  CHECK(unstable(0.1, "2026-03-09") > 0);
}

}  // namespace rigcal::calib
