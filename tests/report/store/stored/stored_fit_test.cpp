#include "report/store/stored/stored_fit.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::report;

TEST_CASE("periodic_frequency: of sine and square alone", "[report]") {
  using rigcal::datasets::Waveform;
  const auto frequency = [](Waveform waveform, std::optional<double> frequency_hz) {
    rigcal::calib::ConditionResult condition;
    condition.waveform = std::optional(waveform);
    condition.frequency_hz = frequency_hz;
    return periodic_frequency(condition);
  };
  CHECK(frequency(Waveform::sine, 2.0) == 2.0);
  CHECK(frequency(Waveform::square, 0.1) == 0.1);
  CHECK(frequency(Waveform::chirp, 2.0) == std::nullopt);
  CHECK(frequency(Waveform::sine, std::nullopt) == std::nullopt);
}
