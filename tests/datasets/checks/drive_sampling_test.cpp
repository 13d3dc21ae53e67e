#include "datasets/checks/drive_sampling.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace rigcal::datasets;
using Catch::Contains;

namespace {

/// Returns the warning for a 2 Hz sine with this time step.
std::string sampling_warning(double step_s, int samples, Condition condition = {}) {
  Record record;
  for (int i = 0; i < samples; ++i) record.time_s.push_back(step_s * i);
  if (!condition.frequency_hz) {
    condition.waveform = Waveform::sine;
    condition.frequency_hz = 2.0;
  }
  return drive_sampling_warning(condition, record);
}

}  // namespace

TEST_CASE("drive_sampling_warning: samples a period", "[datasets]") {
  CHECK(sampling_warning(0.005, 401).empty());
  CHECK(sampling_warning(0.125, 41).empty());  // four samples per period
  CHECK_THAT(sampling_warning(0.126, 41),
             Contains("3.97 samples a period of the sine of 2 Hz") && !Contains("ms"));
  CHECK_THAT(sampling_warning(5.0, 401),
             Contains("0.1 samples a period of the sine of 2 Hz") && Contains("in ms?"));
  CHECK_THAT(sampling_warning(5e-6, 401),
             Contains("0.004 of a period") && Contains("in s, not in ms?"));
  Condition chirp;
  chirp.waveform = Waveform::chirp;
  chirp.frequency_hz = 1.0;
  chirp.end_frequency_hz = 60.0;
  CHECK_THAT(sampling_warning(0.005, 401, chirp),
             Contains("3.33 samples a period of the chirp of 60 Hz"));
  chirp.end_frequency_hz = 40.0;
  CHECK(sampling_warning(0.005, 401, chirp).empty());
}

TEST_CASE("drive_sampling_warning: the stated duration", "[datasets]") {
  Condition recorded;
  recorded.waveform = Waveform::recorded;
  recorded.frequency_hz = 2.0;
  CHECK(sampling_warning(5.0, 401, recorded).empty());
  recorded.duration_s = 2.0;
  CHECK(sampling_warning(0.005, 401, recorded).empty());
  CHECK_THAT(sampling_warning(5.0, 401, recorded),
             Contains("lasts 2000 s, where the campaign states 2 s") && Contains("in ms?"));
  CHECK_THAT(sampling_warning(5e-6, 401, recorded), Contains("in s, not in ms?"));
}
