#include "metrics/agreement_uncertainty.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "metrics/distributions.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::metrics {
namespace {

using Catch::WithinRel;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> sine(std::size_t samples, double amplitude) {
  std::vector<double> values;
  for (std::size_t i = 0; i < samples; ++i)
    values.push_back(amplitude * std::sin(2.0 * std::numbers::pi * 3.0 * static_cast<double>(i) /
                                          static_cast<double>(samples)));
  return values;
}

/// Autocorrelation of noise at one sample.
constexpr double kMemory = 0.95;

/// Repeats of a truth, each with a separate gain and with autocorrelated noise.
struct Repeats {
  std::vector<double> mean;
  std::vector<std::vector<double>> deviations;
};

Repeats draw(const std::vector<double>& truth, int count, double gain_sd, double noise_sd,
             std::mt19937_64& random, double memory = kMemory) {
  std::normal_distribution<double> normal;
  Repeats result{std::vector<double>(truth.size(), 0.0), {}};
  for (int r = 0; r < count; ++r) {
    const double gain = 1.0 + gain_sd * normal(random);
    double noise = noise_sd * normal(random);
    std::vector<double>& own = result.deviations.emplace_back();
    for (const double y : truth) {
      own.push_back(gain * y + noise);
      noise = memory * noise + noise_sd * std::sqrt(1.0 - memory * memory) * normal(random);
    }
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (const auto& own : result.deviations) result.mean[i] += own[i] / count;
    for (auto& own : result.deviations) own[i] -= result.mean[i];
  }
  return result;
}

MeasuredMean measured(const Repeats& repeats) { return {repeats.mean, repeats.deviations}; }

}  // namespace

TEST_CASE("agreement_uncertainty: of a constant error it is t times the standard error",
          "[metrics]") {
  // Each repeat is the truth plus an offset, so the RMSE of their mean is the mean offset.
  const std::vector<double> truth = sine(300, 1.0);
  const std::vector<double> offsets{0.10, 0.12, 0.11, 0.15, 0.12};
  const double mean = 0.12;
  Repeats repeats{truth, {}};
  double squares = 0.0;
  for (double& y : repeats.mean) y += mean;
  for (const double offset : offsets) {
    repeats.deviations.emplace_back(truth.size(), offset - mean);
    squares += (offset - mean) * (offset - mean);
  }
  const auto found = agreement_uncertainty(measured(repeats), truth);
  REQUIRE(found.has_value());
  CHECK_THAT(found->one_sided.rmse,
             WithinRel(student_t_quantile(0.975, 4.0) * std::sqrt(squares / 4.0 / 5.0), 1e-9));
  CHECK(found->one_sided.rho2 < 1e-12);  // insensitive to an offset
}

TEST_CASE("agreement_uncertainty: two-sided, the score of unlimited repeats is within it",
          "[metrics][long]") {
  // The model is exact, off by less than the noise, or off by more. Half of the draws have repeats
  // of different gain, and half have white noise.
  std::mt19937_64 random(20261126);
  const std::vector<double> truth = sine(400, 1.0);
  constexpr int kDraws = 400;
  const int repeats = GENERATE(2, 3, 4, 5);
  for (const double scale : {1.0, 0.995, 0.97}) {
    const std::vector<double> simulated = sine(400, scale);
    const Agreement exact = agreement(truth, simulated);
    std::vector<int> within(kMetrics.size(), 0);
    for (int draw_number = 0; draw_number < kDraws; ++draw_number) {
      const double gain_sd = draw_number % 2 == 0 ? 1e-4 : 0.005;
      const double memory = draw_number % 4 < 2 ? 0.0 : kMemory;
      const Repeats drawn = draw(truth, repeats, gain_sd, 0.02, random, memory);
      const Agreement found = agreement(drawn.mean, simulated);
      const auto uncertainty = agreement_uncertainty(measured(drawn), simulated);
      REQUIRE(uncertainty.has_value());
      for (std::size_t m = 0; m < kMetrics.size(); ++m) {
        const auto score = kMetrics[m].value;
        CHECK(uncertainty->two_sided.*score >= uncertainty->one_sided.*score);
        if (std::abs(exact.*score - found.*score) <= uncertainty->two_sided.*score) ++within[m];
      }
    }
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      CAPTURE(repeats, scale, kMetrics[m].name, within[m]);
      CHECK(within[m] >= kDraws * 0.93);
    }
  }
}

TEST_CASE("agreement_uncertainty: two-sided, the score of an ideal sensor is within it",
          "[metrics][long]") {
  // The sensor's gain and offset have errors of the stated size, or none. The noise left in the
  // mean is larger than these errors, so they hardly change a score.
  std::mt19937_64 random(20261127);
  std::normal_distribution<double> normal;
  const std::vector<double> truth = sine(400, 1.0);
  constexpr int kDraws = 400;
  constexpr double kSensor = 0.004;
  const int repeats = GENERATE(2, 3, 5);
  for (const bool off : {false, true}) {
    for (const double scale : {1.0, 0.97}) {
      const std::vector<double> simulated = sine(400, scale);
      const Agreement exact = agreement(truth, simulated);
      std::vector<int> within(kMetrics.size(), 0);
      for (int draw_number = 0; draw_number < kDraws; ++draw_number) {
        const double memory = draw_number % 2 == 0 ? 0.0 : kMemory;
        Repeats drawn = draw(truth, repeats, 1e-4, 0.02, random, memory);
        const double gain = off ? 1.0 + kSensor * normal(random) : 1.0;
        const double offset = off ? kSensor * normal(random) : 0.0;
        for (double& y : drawn.mean) y = gain * y + offset;
        MeasuredMean with = measured(drawn);
        with.gain_sd = kSensor;
        with.offset_sd = kSensor;
        const Agreement found = agreement(drawn.mean, simulated);
        const auto uncertainty = agreement_uncertainty(with, simulated);
        REQUIRE(uncertainty.has_value());
        for (std::size_t m = 0; m < kMetrics.size(); ++m) {
          const auto score = kMetrics[m].value;
          if (std::abs(exact.*score - found.*score) <= uncertainty->two_sided.*score) ++within[m];
        }
      }
      for (std::size_t m = 0; m < kMetrics.size(); ++m) {
        CAPTURE(repeats, off, scale, kMetrics[m].name, within[m]);
        CHECK(within[m] >= kDraws * 0.93);
      }
    }
  }
}

TEST_CASE("agreement_uncertainty: the score of unlimited repeats is seldom worse than it allows",
          "[metrics][long]") {
  // A quarter of the draws is dominated by the gain of each repeat, and a quarter by noise.
  std::mt19937_64 random(20261125);
  const std::vector<double> truth = sine(400, 1.0);
  std::vector<double> simulated = sine(400, 0.97);
  for (double& s : simulated) s += 0.01;
  const Agreement exact = agreement(truth, simulated);
  constexpr int kDraws = 800;
  const int repeats = GENERATE(2, 3, 5);
  std::vector<int> worse(kMetrics.size(), 0);
  std::vector<double> widths(kMetrics.size(), 0.0);
  std::vector<double> scatter(kMetrics.size(), 0.0);
  for (int draw_number = 0; draw_number < kDraws; ++draw_number) {
    const double gain_sd = draw_number % 4 == 0 ? 1e-4 : 0.01;
    const double noise_sd = draw_number % 4 == 1 ? 1e-4 : 0.02;
    const Repeats drawn = draw(truth, repeats, gain_sd, noise_sd, random);
    const Agreement found = agreement(drawn.mean, simulated);
    const auto uncertainty = agreement_uncertainty(measured(drawn), simulated);
    REQUIRE(uncertainty.has_value());
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      const auto score = kMetrics[m].value;
      const double sign = kMetrics[m].higher_is_better ? -1.0 : 1.0;
      const double distance = sign * (exact.*score - found.*score);  // > 0: the true score is worse
      if (distance > uncertainty->one_sided.*score) ++worse[m];
      widths[m] += uncertainty->one_sided.*score / kDraws;
      scatter[m] += distance * distance / kDraws;
    }
  }
  for (std::size_t m = 0; m < kMetrics.size(); ++m) {
    CAPTURE(repeats, kMetrics[m].name, worse[m], widths[m], std::sqrt(scatter[m]));
    CHECK(worse[m] <= kDraws * 0.04);  // 2.5 % plus statistical variation
    // And the interval is not simply huge: Student's t, and as much for the bias.
    CHECK(widths[m] < 2.2 * student_t_quantile(0.975, repeats - 1.0) * std::sqrt(scatter[m]));
  }
}

TEST_CASE("agreement_uncertainty: a sensor's gain and offset", "[metrics]") {
  const std::vector<double> truth = sine(300, 1.0);
  Repeats repeats{truth, {}};
  repeats.deviations.emplace_back(truth.size(), 1e-9);
  repeats.deviations.emplace_back(truth.size(), -1e-9);
  MeasuredMean with = measured(repeats);
  with.gain_sd = 0.01;
  const auto gain = agreement_uncertainty(with, truth);
  REQUIRE(gain.has_value());
  CHECK_THAT(gain->one_sided.rmse, WithinRel(1.959964 * 0.01 / std::sqrt(2.0), 1e-5));
  with.gain_sd = 0.0;
  with.offset_sd = 0.02;
  const auto offset = agreement_uncertainty(with, truth);
  CHECK_THAT(offset->one_sided.maximum_error, WithinRel(1.959964 * 0.02, 1e-5));
  CHECK_THAT(offset->one_sided.rmse, WithinRel(1.959964 * 0.02, 1e-5));  // same at every sample
  // rho2 is insensitive to a constant, so the offset changes from -0.02 at one end of the range to
  // 0.02 at the other.
  CHECK_THAT(offset->one_sided.rho2, WithinRel(1.959964 * std::pow(0.02 / 0.98, 2.0), 1e-2));
  with.offset_sd = 20.0;  // larger than the signal
  CHECK(agreement_uncertainty(with, truth)->one_sided.rho2 > 0.9);
  with.offset_sd = 0.02;
  with.gain_sd = 0.01;
  CHECK_THAT(agreement_uncertainty(with, truth)->one_sided.rmse,
             WithinRel(std::hypot(gain->one_sided.rmse, offset->one_sided.rmse), 1e-6));
}

TEST_CASE("agreement_uncertainty: what the sensor adds to few repeats adds to their freedom",
          "[metrics]") {
  // Each of three repeats is the truth plus an offset. The sensor's offset is as uncertain as their
  // mean, so the 2 degrees of freedom count four times (Welch and Satterthwaite).
  const std::vector<double> truth = sine(300, 1.0);
  Repeats repeats{truth, {}};
  for (double& y : repeats.mean) y += 0.12;
  for (const double deviation : {-0.02, 0.0, 0.02})
    repeats.deviations.emplace_back(truth.size(), deviation);
  MeasuredMean with = measured(repeats);
  with.offset_sd = 0.02 / std::sqrt(3.0);
  const auto found = agreement_uncertainty(with, truth);
  REQUIRE(found.has_value());
  // 97.5 % quantile of t with 8 degrees of freedom, as printed in tables.
  CHECK_THAT(found->one_sided.rmse, WithinRel(2.306004135 * std::sqrt(2.0) * with.offset_sd, 1e-7));
}

TEST_CASE("agreement_uncertainty: a sensor's gain may be too low as well as too high",
          "[metrics]") {
  const std::vector<double> truth = sine(300, 1.0);
  // The mean reads 0.5 % too high or too low. A gain that moves it further from the truth counts; a
  // gain in the other direction moves it through the truth.
  for (const double reading : {1.005, 0.995}) {
    CAPTURE(reading);
    Repeats repeats{truth, {}};
    for (double& y : repeats.mean) y *= reading;
    repeats.deviations.emplace_back(truth.size(), 1e-9);
    repeats.deviations.emplace_back(truth.size(), -1e-9);
    MeasuredMean with = measured(repeats);
    with.gain_sd = 0.01;
    const double farthest =
        std::max(std::abs(reading * 1.01 - 1.0), std::abs(reading * 0.99 - 1.0));
    const double expected = 1.959964 * (farthest - std::abs(reading - 1.0)) / std::sqrt(2.0);
    const auto found = agreement_uncertainty(with, truth);
    REQUIRE(found.has_value());
    CHECK_THAT(found->one_sided.rmse, WithinRel(expected, 1e-2));
  }
}

TEST_CASE("agreement_uncertainty: where repeats lack samples the others speak", "[metrics]") {
  const std::vector<double> truth = sine(100, 1.0);
  Repeats repeats{truth, {}};
  for (const double offset : {-0.1, 0.0, 0.1}) repeats.deviations.emplace_back(100, offset);
  const auto whole = agreement_uncertainty(measured(repeats), truth);
  // If only one repeat has a sample, there is no mean of the others.
  repeats.deviations[0][0] = repeats.deviations[1][0] = kNan;
  repeats.deviations[0][1] = kNan;
  const auto part = agreement_uncertainty(measured(repeats), truth);
  REQUIRE((whole && part));
  CHECK(std::isfinite(part->one_sided.rmse));
  CHECK_THAT(part->one_sided.rmse, WithinRel(whole->one_sided.rmse, 0.05));
  CHECK(part->one_sided.rmse != whole->one_sided.rmse);
}

TEST_CASE("agreement_uncertainty: another cause counts as a gain of the same effect", "[metrics]") {
  const std::vector<double> truth = sine(500, 1.0);
  std::mt19937_64 random(3);
  const Repeats repeats = draw(truth, 5, 0.01, 0.01, random);
  MeasuredMean by_gain = measured(repeats);
  by_gain.gain_sd = 0.01;
  MeasuredMean by_change = measured(repeats);
  std::vector<double>& change = by_change.changes.emplace_back();
  for (const double y : repeats.mean) change.push_back(0.01 * y);
  const auto without = agreement_uncertainty(measured(repeats), truth);
  const auto gain = agreement_uncertainty(by_gain, truth);
  const auto other = agreement_uncertainty(by_change, truth);
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    CHECK_THAT(other->one_sided.*metric.value, WithinRel(gain->one_sided.*metric.value, 1e-6));
  }
  CHECK(other->one_sided.rmse > 1.05 * without->one_sided.rmse);
}

TEST_CASE("agreement_uncertainty: the contributions add up by hand", "[metrics]") {
  const std::vector<double> truth = sine(500, 1.0);
  std::mt19937_64 random(5);
  const Repeats repeats = draw(truth, 5, 0.01, 0.01, random);
  MeasuredMean with = measured(repeats);
  with.gain_sd = 0.01;
  with.offset_sd = 0.02;
  with.changes.emplace_back(truth.size(), 0.03);
  const auto found = agreement_uncertainty(with, truth);
  REQUIRE(found.has_value());
  const ScoreContributions& parts = found->contributions;
  REQUIRE(parts.changes.size() == 1);
  double noise_left = 0.0;
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    const auto score = metric.value;
    const double sensor = std::hypot(parts.gain.*score, parts.offset.*score);
    const double lasting = std::hypot(parts.repeats.*score, sensor, parts.changes[0].*score);
    const double factor = parts.coverage_factor.*score;
    CHECK_THAT(factor * lasting, WithinRel(found->one_sided.*score, 1e-9));
    CHECK_THAT(factor * std::hypot(lasting, parts.noise_left.*score),
               WithinRel(found->two_sided.*score, 1e-9));
    CHECK_THAT(student_t_quantile(0.975, parts.degrees_of_freedom.*score), WithinRel(factor, 1e-5));
    CHECK(parts.degrees_of_freedom.*score >= 4.0 * (1.0 - 1e-9));
    noise_left += parts.noise_left.*score;
  }
  CHECK(noise_left > 0.0);
  CHECK(parts.repeats.rmse > 0.0);
  CHECK(parts.gain.rmse > 0.0);
  // Constant changes of the mean; the larger one moves the RMSE further.
  CHECK(parts.changes[0].rmse > parts.offset.rmse);
  // Without a certificate there is no such contribution, and the others stay.
  with.gain_sd = 0.0;
  with.offset_sd = 0.0;
  const auto without = agreement_uncertainty(with, truth);
  CHECK(without->contributions.gain.rmse == 0.0);
  CHECK(without->contributions.offset.rmse == 0.0);
  CHECK(without->contributions.repeats.rmse == parts.repeats.rmse);
  CHECK(without->contributions.changes[0].rmse == parts.changes[0].rmse);
}

TEST_CASE("agreement_uncertainty: one repeat and copies tell nothing", "[metrics]") {
  const std::vector<double> truth = sine(100, 1.0);
  Repeats repeats{truth, {}};
  CHECK_FALSE(agreement_uncertainty(measured(repeats), truth).has_value());
  repeats.deviations.emplace_back(100, 0.1);
  CHECK_FALSE(agreement_uncertainty(measured(repeats), truth).has_value());
  repeats.deviations.back().assign(100, 0.0);
  CHECK_FALSE(agreement_uncertainty(measured(repeats), truth).has_value());
  repeats.deviations.emplace_back(100, 0.0);
  CHECK_FALSE(agreement_uncertainty(measured(repeats), truth).has_value());
  repeats.deviations.back()[7] = 0.1;
  CHECK(agreement_uncertainty(measured(repeats), truth).has_value());
}

}  // namespace rigcal::metrics
