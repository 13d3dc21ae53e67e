// The shipped rigs in radians, fitted to their records if these are available (docs/excavator.md).

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "calib/fit.hpp"
#include "datasets/prepare/load_record.hpp"

namespace rigcal::calib {
namespace {

/// @param held_back  end of the name of a condition that is scored but not fitted; may be empty
std::optional<Fit> fitted(const std::string& rig, const std::string& held_back = {}) {
  const std::filesystem::path data =
      std::filesystem::path(RIGCAL_RECORDINGS_DIR) / "excavator_dspace";
  if (!std::filesystem::exists(data)) {
    WARN("skipped: " << data << " is absent");
    return std::nullopt;
  }
  const std::filesystem::path file =
      std::filesystem::path(RIGCAL_SOURCE_DIR) / "datasets/rigs/excavator_dspace" / (rig + ".toml");
  datasets::Campaign campaign = datasets::load_campaign(file, data);
  if (!held_back.empty()) {
    for (datasets::Condition& each : campaign.conditions)
      if (each.id.ends_with(held_back)) each.use = datasets::Use::validate;
    campaign.decimate_to_hz = 20.0;  // coarse data are enough to test the prediction
  }
  const auto records =
      datasets::load_records(campaign, {datasets::Use::fit, datasets::Use::validate}, 1, true);
  return fit(campaign, records, FitOptions());
}

/// Returns the smallest rho2 of a channel over the conditions.
double least_rho2(const Fit& fit, datasets::Channel channel) {
  double least = 1.0;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& each : score.channels)
      if (each.channel == channel) least = std::min(least, each.metrics.rho2);
  }
  return least;
}

double rho2_of(const Fit& fit, const std::string& condition, datasets::Channel channel) {
  for (const ConditionScore& score : fit.conditions) {
    if (score.id != condition) continue;
    for (const ChannelScore& each : score.channels)
      if (each.channel == channel) return each.metrics.rho2;
  }
  return -1.0;
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

TEST_CASE("excavator: angle and both pressures of the boom, up", "[calib][long]") {
  const auto boom = fitted("boom_up");
  if (!boom) return;
  CHECK(boom->conditions.size() == 3);
  CHECK(least_rho2(*boom, datasets::Channel::angle) > 0.998);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_a) > 0.9);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_b) > 0.8);
}

TEST_CASE("excavator: angle and both pressures of the arm, in", "[calib][long]") {
  const auto arm = fitted("arm_in");
  if (!arm) return;
  CHECK(arm->conditions.size() == 3);
  CHECK(least_rho2(*arm, datasets::Channel::angle) > 0.998);
  CHECK(least_rho2(*arm, datasets::Channel::pressure_a) > 0.96);
  CHECK(least_rho2(*arm, datasets::Channel::pressure_b) > 0.93);
}

TEST_CASE("excavator: angle and both pressures of the boom, down", "[calib][long]") {
  const auto boom = fitted("boom_down");
  if (!boom) return;
  CHECK(boom->conditions.size() == 3);
  CHECK(least_rho2(*boom, datasets::Channel::angle) > 0.997);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_a) > 0.96);
  CHECK(least_rho2(*boom, datasets::Channel::pressure_b) > 0.83);
}

TEST_CASE("excavator: the duty of a record that was held back", "[calib][long]") {
  using Channel = datasets::Channel;
  struct Row {
    const char* rig;
    const char* duty;
    Channel head;
    Channel rod;
  };
  for (const Row& row : {Row{"boom_up", "070", Channel::pressure_a, Channel::pressure_b},
                         Row{"arm_in", "090", Channel::pressure_b, Channel::pressure_a},
                         Row{"boom_down", "070", Channel::pressure_a, Channel::pressure_b}}) {
    CAPTURE(row.rig);
    const auto machine = fitted(row.rig, row.duty);
    if (!machine) return;
    REQUIRE(machine->conditions.size() == 3);
    const std::string held = fmt::format("{}_{}", row.rig, row.duty);
    CHECK(rho2_of(*machine, held, Channel::angle) > 0.98);
    CHECK(rho2_of(*machine, held, row.head) > 0.9);
    CHECK(rho2_of(*machine, held, row.rod) > 0.8);
  }
}

}  // namespace rigcal::calib
