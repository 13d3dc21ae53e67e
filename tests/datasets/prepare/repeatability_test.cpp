#include "datasets/prepare/repeatability.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace rigcal::datasets;
using Catch::WithinRel;

namespace {

Record record_of(const Series& series) {
  Record record;
  record.condition = "sine";
  record.time_s = {0.0, 1.0, 2.0, 3.0};
  record.channels[Channel::position] = series;
  record.repeat_reports = {
      {"a.csv", 0.002, 1.0, false}, {"b.csv", -0.003, 9.0, true}, {"c.csv", 0.001, 1.0, false}};
  return record;
}

}  // namespace

TEST_CASE("repeatability: the noise floor is that of the mean", "[datasets]") {
  Series series;
  series.mean = {1.0, -1.0, 1.0, -1.0};  // variance 1
  series.repeats = 4;
  series.pooled_sd = 0.2;
  series.sd_of_mean = 0.1;
  const auto rows = repeatability(record_of(series));
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].channel == Channel::position);
  CHECK(rows[0].unit == "m");
  CHECK(rows[0].repeats == 4);
  CHECK(rows[0].pooled_sd == 0.2);
  CHECK(rows[0].sd_of_mean == 0.1);
  REQUIRE(rows[0].noise_floor.has_value());
  CHECK_THAT(rows[0].noise_floor->rho2, WithinRel(0.99, 1e-12));  // 1 - 0.1^2 / 1
}

TEST_CASE("repeatability: no noise floor without noise or without signal", "[datasets]") {
  Series unknown;
  unknown.mean = {1.0, -1.0, 1.0, -1.0};
  CHECK_FALSE(repeatability(record_of(unknown))[0].noise_floor.has_value());
  CHECK(std::isnan(repeatability(record_of(unknown))[0].sd_of_mean));
  Series constant;
  constant.mean = {3.0, 3.0, 3.0, 3.0};
  constant.sd_of_mean = 0.1;
  CHECK_FALSE(repeatability(record_of(constant))[0].noise_floor.has_value());
}

TEST_CASE("repeatability: offsets and outliers of the repeats", "[datasets]") {
  const Record record = record_of({});
  CHECK_THAT(offset_range_s(record), WithinRel(0.005, 1e-12));
  CHECK(outliers(record) == std::vector<std::string>{"b.csv"});
  CHECK(offset_range_s(Record{}) == 0.0);
}
