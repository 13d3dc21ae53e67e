#include "diagnosis/record/record_share.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "common/error.hpp"

using namespace rigcal;
using Catch::WithinRel;

namespace {

/// Samples of a condition at intervals of 10 ms, all of which count.
struct Sampled {
  datasets::Condition condition;
  datasets::Record record;
  calib::ProblemCondition prepared;

  explicit Sampled(std::size_t samples) {
    condition.id = "sampled";
    condition.waveform = datasets::Waveform::sine;
    condition.frequency_hz = 1.0;
    for (std::size_t i = 0; i < samples; ++i)
      record.time_s.push_back(0.01 * static_cast<double>(i));
    prepared.condition = &condition;
    prepared.record = &record;
    prepared.rows.resize(samples);
    std::iota(prepared.rows.begin(), prepared.rows.end(), std::size_t{0});
  }
  Sampled(const Sampled&) = delete;
};

}  // namespace

TEST_CASE("steady_part: the last whole periods, of three or more without the first",
          "[diagnosis]") {
  const auto part = [](std::size_t samples) {
    const Sampled sampled(samples);
    const auto found = diagnosis::steady_part(sampled.prepared);
    return std::pair(found.first, found.count);
  };
  CHECK(part(51) == std::pair<std::size_t, std::size_t>(0, 51));     // half a period
  CHECK(part(101) == std::pair<std::size_t, std::size_t>(0, 101));   // one period
  CHECK(part(251) == std::pair<std::size_t, std::size_t>(50, 201));  // two and a half periods
  CHECK(part(301) == std::pair<std::size_t, std::size_t>(100, 201));
  CHECK(part(551) == std::pair<std::size_t, std::size_t>(150, 401));
  CHECK_THROWS_AS(part(1), NoResultError);
}

TEST_CASE("steady_part: of a recorded drive all that count", "[diagnosis]") {
  Sampled sampled(551);
  sampled.condition.waveform = datasets::Waveform::recorded;
  sampled.prepared.rows.erase(sampled.prepared.rows.begin(), sampled.prepared.rows.begin() + 20);
  const auto part = diagnosis::steady_part(sampled.prepared);
  CHECK(part.first == 20);
  CHECK(part.count == 531);
}

TEST_CASE("leak_in_record: means of the flows' sizes, and their slopes", "[diagnosis]") {
  const Sampled sampled(201);
  model::Simulation run;
  run.outputs.resize(201, 3);  // position, servo flow, leakage flow
  run.outputs.col(0).setConstant(7.0);
  run.outputs.col(1).setConstant(-4.0);
  run.outputs.col(2).setConstant(1.0);
  const auto plain = diagnosis::leak_in_record(sampled.prepared, run, 1);
  CHECK_THAT(plain.share, WithinRel(0.25, 1e-12));
  CHECK_THAT(plain.leak_flow_m3_per_s, WithinRel(1.0, 1e-12));
  CHECK(plain.share_slope.size() == 0);
  CHECK_FALSE(plain.is_periodic);
  run.sensitivities.assign(3, Eigen::MatrixXd::Zero(201, 1));
  run.sensitivities[1].setConstant(-2.0);  // |servo| increases by 2
  run.sensitivities[2].setConstant(3.0);
  const auto sloped = diagnosis::leak_in_record(sampled.prepared, run, 1);
  CHECK_THAT(sloped.flow_slope(0), WithinRel(3.0, 1e-12));
  // (leak / servo)' = (3 - 0.25 * 2) / 4
  CHECK_THAT(sloped.share_slope(0), WithinRel(0.625, 1e-12));
  run.outputs.col(1).setZero();
  CHECK_THROWS_AS(diagnosis::leak_in_record(sampled.prepared, run, 1), NoResultError);
}
