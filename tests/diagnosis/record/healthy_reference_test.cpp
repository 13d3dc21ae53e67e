#include "diagnosis/record/healthy_reference.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using datasets::Channel;

TEST_CASE("take_off: the mean of the healthy residuals goes, at the nearest sample",
          "[diagnosis]") {
  datasets::Record record;
  record.time_s = {0.0, 1.0, 2.0, 3.0};
  record.channels[Channel::position].mean = {10.0, 20.0, 30.0, 40.0};
  record.channels[Channel::pressure_a].mean = {1.0, 2.0, 3.0, 4.0};
  // The samples of the first reference are 0.4 s late. The one nearest to record time t is at
  // t + 0.4, not at t - 0.6, and there is none beyond the last.
  const std::map<Channel, std::vector<double>> late{{Channel::position, {1.0, 2.0, 3.0, 4.0}}};
  const std::vector<double> late_s{0.4, 1.4, 2.4, 3.4};
  // The samples of the second one are 0.4 s early, so the nearest is the one below.
  const std::map<Channel, std::vector<double>> early{{Channel::position, {3.0, 6.0, 9.0, 12.0}}};
  const std::vector<double> early_s{-0.4, 0.6, 1.6, 2.6};
  const std::vector<TimedResidual> healthy{{&late, &late_s}, {&early, &early_s}};
  take_off(healthy, record);
  const auto& position = record.channels[Channel::position].mean;
  CHECK_THAT(position[0], WithinAbs(10.0 - 2.0, 1e-12));
  CHECK_THAT(position[1], WithinAbs(20.0 - 4.0, 1e-12));
  CHECK_THAT(position[2], WithinAbs(30.0 - 6.0, 1e-12));
  CHECK_THAT(position[3], WithinAbs(40.0 - 8.0, 1e-12));
  // A channel that the reference does not have is unchanged.
  CHECK(record.channels[Channel::pressure_a].mean == std::vector<double>{1.0, 2.0, 3.0, 4.0});
}

TEST_CASE("take_off: a record less its own residual is the model", "[diagnosis]") {
  datasets::Record record;
  record.time_s = {0.0, 0.5};
  record.channels[Channel::position].mean = {2.5, 3.5};
  const std::map<Channel, std::vector<double>> own{{Channel::position, {0.5, -0.5}}};
  const std::vector<TimedResidual> healthy{{&own, &record.time_s}};
  take_off(healthy, record);
  CHECK(record.channels[Channel::position].mean == std::vector<double>{2.0, 4.0});
}

TEST_CASE("features_within: samples at both ends count, those beyond do not", "[diagnosis]") {
  const std::vector<double> residual{100.0, -3.0, 4.0, 3.0, -4.0, 100.0};
  const std::vector<double> time_s{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  const auto inside = features_within(residual, time_s, datasets::TimeWindow{1.0, 4.0});
  CHECK_THAT(inside.mean, WithinAbs(3.5, 1e-12));
  CHECK_THAT(inside.rms, WithinAbs(std::sqrt(12.5), 1e-12));
  CHECK_THAT(inside.std, WithinAbs(0.5, 1e-12));
  CHECK_THAT(features_within(residual, time_s, std::nullopt).mean, WithinAbs(214.0 / 6.0, 1e-12));
}
