#include "datasets/prepare/condition_repeats.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "datasets/synthetic/noise.hpp"
#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

Campaign with(const std::string& recording) {
  return load_text(replaced(kExample, "initial = \"rest\"", "initial = \"rest\"\n" + recording));
}

/// A 1 kHz record of a sine with noise, a stepped reference, and two spikes in the position.
Repeat recorded(const std::string& source, double rate_hz = 1000.0) {
  auto stream = random_stream(2, {source});
  Repeat repeat;
  repeat.source = source;
  for (int i = 0; i < 2000; ++i) {
    repeat.time_s.push_back(i / rate_hz);
    repeat.values[Channel::reference].push_back(i < 1000 ? 0.0 : 1.0);
    repeat.values[Channel::position].push_back(0.1 * std::sin(0.01 * i) + normal(stream, 1e-4));
  }
  repeat.values[Channel::position][300] += 0.02;
  repeat.values[Channel::position][1500] -= 0.03;
  return repeat;
}

}  // namespace

TEST_CASE("condition_repeats: spikes are named and stay", "[datasets]") {
  std::vector<Repeat> repeats{recorded("a.csv 1"), recorded("a.csv 2")};
  const auto before = repeats;
  const Conditioning done = condition_repeats(with(""), repeats);
  REQUIRE(done.warnings.size() == 1);
  CHECK_THAT(done.warnings[0], Contains("position: 4 spikes in 2 repeats, the largest: a.csv ") &&
                                   Contains("a.csv 2 sample 1501 (1.5 s) -0.0") &&
                                   Contains("stay in the record"));
  CHECK(done.notes.empty());
  CHECK(done.noise_gain == 1.0);
  CHECK(repeats[0].values == before[0].values);
}

TEST_CASE("condition_repeats: spikes are excluded on request", "[datasets]") {
  std::vector<Repeat> repeats{recorded("a.csv")};
  const Conditioning done = condition_repeats(with("spikes = \"exclude\""), repeats);
  REQUIRE(done.notes.size() == 1);
  CHECK_THAT(done.notes[0], Contains("2 samples replaced"));
  CHECK_THAT(repeats[0].values[Channel::position][300], WithinAbs(0.1 * std::sin(3.0), 1e-3));
}

TEST_CASE("condition_repeats: decimation is stated and keeps signals in place", "[datasets]") {
  std::vector<Repeat> repeats{recorded("a.csv 1"), recorded("a.csv 2")};
  const Conditioning done =
      condition_repeats(with("spikes = \"exclude\"\ndecimate_to = \"200 Hz\""), repeats);
  REQUIRE(done.notes.size() == 2);
  CHECK_THAT(done.notes[1], Contains("decimated 5-fold to 200 Hz") && Contains("-6 dB at 100 Hz"));
  CHECK_THAT(done.noise_gain, WithinRel(1.0 / std::sqrt(5.0), 0.05));
  REQUIRE(repeats[0].time_s.size() == 400);
  CHECK_THAT(repeats[0].time_s[1], WithinAbs(5e-3, 1e-12));
  CHECK_THAT(repeats[0].values[Channel::position][100], WithinAbs(0.1 * std::sin(5.0), 4e-4));
  const auto& reference = repeats[0].values[Channel::reference];
  CHECK(reference[199] == 0.0);  // no ringing at the edge
  CHECK(reference[200] == 1.0);
}

TEST_CASE("condition_repeats: what cannot be decimated", "[datasets]") {
  std::vector<Repeat> slow{recorded("slow.csv", 100.0)};
  CHECK_THAT(condition_repeats(with("decimate_to = \"200 Hz\""), slow).notes.back(),
             Contains("not decimated"));
  std::vector<Repeat> mixed{recorded("a.csv"), recorded("b.csv", 2000.0)};
  CHECK_THROWS_WITH(condition_repeats(with("decimate_to = \"200 Hz\""), mixed),
                    Contains("every 5th sample of a.csv but every 10th of b.csv"));
  std::vector<Repeat> odd{recorded("a.csv")};
  CHECK_THROWS_WITH(condition_repeats(with("decimate_to = \"300 Hz\""), odd),
                    Contains("expected a whole factor"));
  CHECK_THROWS_WITH(with("decimate_to = 200"), Contains("decimate_to"));
  CHECK_THROWS_WITH(with("decimate_to = \"0 Hz\""), Contains("decimate_to"));
  CHECK_THROWS_WITH(with("spikes = \"drop\""), Contains("exclude"));
}

TEST_CASE("condition_repeats: a command may jump for a sample", "[datasets]") {
  std::vector<Repeat> repeats{recorded("a.csv")};
  auto& position = repeats[0].values[Channel::position];
  position[1501] -= 0.03;  // this spike now has two samples
  for (const Channel channel : {Channel::reference, Channel::command}) {
    auto& values = repeats[0].values[channel];
    values.clear();
    for (int i = 0; i < 2000; ++i) values.push_back(i % 2 == 0 ? 1e-3 : -1e-3);
    values[700] = 5.0;
  }
  const Conditioning done = condition_repeats(with("spikes = \"exclude\""), repeats);
  REQUIRE(done.warnings.size() == 1);
  CHECK_THAT(done.warnings[0], Contains("position: 2 spikes in 1 repeat"));
  CHECK_THAT(done.notes.at(0), Contains("3 samples replaced"));
  CHECK(repeats[0].values[Channel::command][700] == 5.0);
  CHECK(repeats[0].values[Channel::reference][700] == 5.0);
}
