#include "report/page/calibration/page_agreement_figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "report/page/calibration/fit_sections.hpp"

using namespace rigcal::report;
using Catch::Contains;

namespace {

/// A record of `seconds` duration at 200 Hz, and a model that lags by 10 ms.
Table driven(double seconds, double frequency_hz) {
  Table table;
  table.names = {"time_s", "measured_position_m", "simulated_position_m", "in_window",
                 "reference_m"};
  table.columns.resize(5);
  const auto count = static_cast<int>(seconds * 200.0);
  for (int i = 0; i < count; ++i) {
    const double t = i / 200.0;
    const auto sine = [&](double at) {
      return 0.05 * std::sin(2.0 * std::numbers::pi * frequency_hz * at);
    };
    // Noise that does not repeat from period to period.
    const double noise = 1e-4 * ((i * 7919 % 1009) / 1009.0 - 0.5);
    table.columns[0].push_back(t);
    table.columns[1].push_back(sine(t) + noise);
    table.columns[2].push_back(sine(t - 0.01));
    table.columns[3].push_back(i < 20 ? 0.0 : 1.0);
    table.columns[4].push_back(sine(t));
  }
  return table;
}

}  // namespace

TEST_CASE("channel_agreements: four figures where a drive tells gain and phase", "[report]") {
  const auto channels = channel_agreements("sine", 2.0, driven(5.0, 2.0));
  REQUIRE(channels.size() == 1);
  CHECK(channels[0].channel == "position");
  std::vector<std::string> names;
  for (const Figure& figure : channels[0].figures) names.push_back(figure.name);
  CHECK(names == std::vector<std::string>{"position_parity", "position_histogram", "position_gain",
                                          "position_phase"});
  CHECK_THAT(channels[0].residual, Contains("over 980 samples"));  // only those in the window
  CHECK_THAT(channels[0].response,
             Contains("position over reference at the fundamental") && Contains("95 % intervals"));
  // The model lags by 10 ms, which is 7.2 degrees at 2 Hz.
  const Plot& phase = channels[0].figures[3].plot;
  CHECK_THAT(phase.traces.front().y.front(), Catch::WithinAbs(-7.2, 0.01));
  CHECK_THAT(phase.traces.back().y.front(), Catch::WithinAbs(0.0, 0.05));
}

TEST_CASE("channel_agreements: says why there is no gain and phase", "[report]") {
  Table table = driven(5.0, 2.0);
  const auto response = [](const Table& series, std::optional<double> frequency_hz) {
    const auto channels = channel_agreements("c", frequency_hz, series);
    REQUIRE(channels.size() == 1);
    CHECK(channels[0].figures.size() == 2);
    return channels[0].response;
  };
  CHECK_THAT(response(table, 0.1), Contains("less than a period"));
  CHECK_THAT(response(table, 90.0), Contains("fewer than 10 samples"));
  Table without = table;
  without.names.pop_back();
  without.columns.pop_back();
  CHECK_THAT(response(without, 2.0), Contains("no drive is stored"));
  Table gap = table;
  gap.columns[1][500] = std::nan("");
  CHECK_THAT(response(gap, 2.0), Contains("gaps"));
  Table uneven = table;
  for (std::size_t i = 500; i < uneven.columns[0].size(); ++i) uneven.columns[0][i] += 0.5;
  CHECK_THAT(response(uneven, std::nullopt), Contains("not equidistant"));
  CHECK_THAT(response(uneven, 2.0), Contains("not equidistant"));
}

TEST_CASE("channel_agreements: none of a few samples, or of no model", "[report]") {
  CHECK(channel_agreements("c", 2.0, driven(0.3, 2.0)).empty());
  CHECK(channel_agreements("c", 2.0, Table{}).empty());
}

TEST_CASE("rig_response_figures: the responses of all conditions in one", "[report]") {
  Calibration stored;
  for (const double frequency_hz : {1.0, 2.0, 4.0}) {
    rigcal::calib::ConditionResult& condition = stored.result.conditions.emplace_back();
    condition.id = "sine" + std::to_string(stored.result.conditions.size());
    condition.waveform = std::optional(rigcal::datasets::Waveform::sine);
    condition.frequency_hz = std::optional(frequency_hz);
    condition.channels.emplace_back().channel = rigcal::datasets::Channel::position;
  }
  stored.series = [](std::size_t i) {
    return std::make_shared<const Table>(driven(5.0, std::pow(2.0, static_cast<double>(i))));
  };
  const auto figures = rig_response_figures(stored);
  REQUIRE(figures.size() == 2);
  CHECK(figures[0].name == "rig_position_gain");
  CHECK(figures[1].name == "rig_position_phase");
  // The model lags by 10 ms. Between conditions is a gap.
  const Trace& model = figures[1].plot.traces.front();
  REQUIRE(model.x.size() == 5);
  CHECK_THAT(model.y[0], Catch::WithinAbs(-3.6, 0.01));
  CHECK_THAT(model.y[2], Catch::WithinAbs(-7.2, 0.01));
  CHECK_THAT(model.y[4], Catch::WithinAbs(-14.4, 0.01));
  CHECK(std::isnan(model.x[1]));
  stored.result.conditions.resize(1);
  CHECK(rig_response_figures(stored).empty());  // a single frequency
}
