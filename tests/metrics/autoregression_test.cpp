#include "metrics/autoregression.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal::metrics {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;

std::vector<double> series(const std::vector<double>& phi, std::size_t samples, unsigned seed) {
  boost::random::mt19937_64 random(seed);
  boost::random::normal_distribution<double> normal;
  std::vector<double> x(samples);
  for (std::size_t t = 0; t < samples; ++t) {
    x[t] = normal(random);
    for (std::size_t k = 0; k < phi.size() && k < t; ++k) x[t] += phi[k] * x[t - 1 - k];
  }
  return x;
}

}  // namespace

TEST_CASE("autoregression: its autocovariances are those of the closed form", "[metrics]") {
  const auto first = autocovariance(Autoregression{{0.8}, 2.0}, 3);
  for (std::size_t h = 0; h < first.size(); ++h)  // 1e-12: rounding
    CHECK_THAT(first[h], WithinRel(2.0 / (1.0 - 0.64) * std::pow(0.8, h), 1e-12));
  // For the second order, the Yule-Walker equations must be satisfied.
  const std::vector<double> phi{0.5, -0.3};
  const auto gamma = autocovariance(Autoregression{phi, 1.0}, 4);
  CHECK_THAT(gamma[0], WithinAbs(phi[0] * gamma[1] + phi[1] * gamma[2] + 1.0, 1e-12));
  for (std::size_t h = 1; h < gamma.size(); ++h) {
    const double before = gamma[h == 1 ? 1 : h - 2];
    CHECK_THAT(gamma[h], WithinAbs(phi[0] * gamma[h - 1] + phi[1] * before, 1e-12));
  }
}

TEST_CASE("autoregression: a model is found again from its autocovariances", "[metrics]") {
  const Autoregression truth{{0.5, -0.3}, 1.7};
  const Autoregression found = fit_autoregression(autocovariance(truth, 10), 1000.0);
  REQUIRE(found.phi.size() == 2);
  CHECK_THAT(found.phi[0], WithinAbs(0.5, 1e-12));
  CHECK_THAT(found.phi[1], WithinAbs(-0.3, 1e-12));
  CHECK_THAT(found.variance, WithinAbs(1.7, 1e-12));
}

TEST_CASE("autoregression: order and coefficient from a series", "[metrics]") {
  const auto white = series({}, 2000, 3);
  CHECK(fit_autoregression(autocovariance(white, 20), 2000.0).phi.empty());
  const auto slow = series({0.95}, 2000, 3);
  const Autoregression found = fit_autoregression(autocovariance(slow, 20), 2000.0);
  REQUIRE(found.phi.size() == 1);
  // The standard error is sqrt((1 - 0.95^2) / 2000) = 0.007; the tolerance is four times that.
  CHECK_THAT(found.phi[0], WithinAbs(0.95, 0.028));
  // (1 - 0.95) / (1 + 0.95) of the samples are 51. Four standard errors of the coefficient halve or
  // double this number.
  CHECK(found.effective_samples(2000.0) > 20.0);
  CHECK(found.effective_samples(2000.0) < 120.0);
}

TEST_CASE("autoregression: constant, empty and short series give a white model", "[metrics]") {
  CHECK(fit_autoregression(autocovariance(std::vector<double>(10, 0.0), 5), 10.0).phi.empty());
  CHECK(autocovariance(std::vector<double>{}, 2) == std::vector<double>{0.0, 0.0, 0.0});
  const Autoregression constant =
      fit_autoregression(autocovariance(std::vector<double>(100, 1.0), 20), 100.0);
  CHECK(std::isfinite(constant.variance));
  CHECK(constant.variance > 0.0);
  CHECK(constant.effective_samples(100.0) >= 1.0);
}

TEST_CASE("autoregression: of a series that repeats itself the model stays within bounds",
          "[metrics]") {
  // Two partial autocorrelations describe a sine. The rest is rounding divided by almost zero.
  std::vector<double> sine(3001);
  for (std::size_t t = 0; t < sine.size(); ++t)
    sine[t] = std::sin(2.0 * 3.14159265358979 * static_cast<double>(t) / 10.0);
  const Autoregression found = fit_autoregression(autocovariance(sine, 20), 3001.0);
  REQUIRE(found.phi.size() >= 2);
  std::vector<double> response{1.0};
  double largest = 0.0;
  for (std::size_t t = 1; t < sine.size(); ++t) {
    double next = 0.0;
    for (std::size_t k = 0; k < found.phi.size() && k < t; ++k)
      next += found.phi[k] * response[t - 1 - k];
    response.push_back(next);
    largest = std::max(largest, std::abs(next));
  }
  CHECK(largest < 100.0);  // 1.7e7 if every partial autocorrelation were limited and used
  CHECK(found.variance > 0.0);
}

TEST_CASE("autoregression: which sequences are autocovariances", "[metrics]") {
  CHECK(is_autocovariance(std::vector{1.0, 0.9, 0.8}));
  CHECK(is_autocovariance(autocovariance(Autoregression{{0.5, -0.3}, 1.0}, 10)));
  CHECK(is_autocovariance(autocovariance(series({0.95}, 500, 3), 20)));
  CHECK_FALSE(is_autocovariance(std::vector{1.0, 1.01}));
  // Each lag by itself would be possible, but after 0.9 the minimum is cos(acos(0.9) + acos(0.9)) =
  // 0.62.
  CHECK(is_autocovariance(std::vector{1.0, 0.9, 0.63}));
  CHECK_FALSE(is_autocovariance(std::vector{1.0, 0.9, 0.61}));
  CHECK_FALSE(is_autocovariance(std::vector{0.0, 0.0}));
  CHECK_FALSE(is_autocovariance(std::vector{-1.0, 0.5}));
  CHECK_FALSE(is_autocovariance(std::vector<double>{}));
}

TEST_CASE("autoregression: partial autocorrelations end at the order of the model", "[metrics]") {
  const auto partial =
      partial_autocorrelations(autocovariance(Autoregression{{0.5, -0.3}, 1.0}, 5));
  REQUIRE(partial.size() == 5);
  CHECK_THAT(partial[0], Catch::WithinAbs(0.5 / 1.3, 1e-12));
  CHECK_THAT(partial[1], Catch::WithinAbs(-0.3, 1e-12));
  for (std::size_t k = 2; k < 5; ++k) CHECK_THAT(partial[k], Catch::WithinAbs(0.0, 1e-12));
  CHECK(partial_autocorrelations(std::vector{1.0, 0.9, 0.61, 0.5}).size() == 1);
  CHECK(partial_autocorrelations(std::vector{0.0, 0.0}).empty());
}

}  // namespace rigcal::metrics
