// The shipped rigs in radians, fitted to their records where these are there (docs/excavator.md).

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>

#include "calib/fit.hpp"
#include "datasets/prepare/load_record.hpp"

namespace rigcal::calib {
namespace {

std::optional<Fit> fitted(const std::string& rig) {
  const std::filesystem::path data =
      std::filesystem::path(RIGCAL_RECORDINGS_DIR) / "excavator_dspace";
  if (!std::filesystem::exists(data)) {
    WARN("skipped: " << data << " is absent");
    return std::nullopt;
  }
  const std::filesystem::path file =
      std::filesystem::path(RIGCAL_SOURCE_DIR) / "datasets/rigs/excavator_dspace" / (rig + ".toml");
  const datasets::Campaign campaign = datasets::load_campaign(file, data);
  const auto records = datasets::load_records(campaign, {datasets::Use::fit}, 1, true);
  return fit(campaign, records, FitOptions());
}

/// Smallest rho2 of a channel over the conditions.
double least_rho2(const Fit& fit, datasets::Channel channel) {
  double least = 1.0;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& each : score.channels)
      if (each.channel == channel) least = std::min(least, each.agreement->rho2);
  }
  return least;
}

}  // namespace

TEST_CASE("excavator: angle and both pressures of the arm, out", "[calib]") {
  const auto arm = fitted("arm_out");
  if (!arm) return;
  CHECK(arm->conditions.size() == 3);
  CHECK(least_rho2(*arm, datasets::Channel::angle) > 0.998);
  CHECK(least_rho2(*arm, datasets::Channel::pressure_a) > 0.98);
  CHECK(least_rho2(*arm, datasets::Channel::pressure_b) > 0.91);
}

TEST_CASE("excavator: angle and both pressures of the boom, up", "[calib]") {
  const auto boom = fitted("boom_up");
  if (!boom) return;
  CHECK(boom->conditions.size() == 3);
  CHECK(least_rho2(*boom, datasets::Channel::angle) > 0.998);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_a) > 0.9);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_b) > 0.8);
}

}  // namespace rigcal::calib
