#include "datasets/prepare/decimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "datasets/prepare/resample.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kRippleDb = 66.0;        // 0.05 %; 0.1 % including the error of the formula
constexpr double kTransitionShare = 0.2;  // transition band, from 0.4 to 0.6 of the new sample rate

}  // namespace

double AntiAliasFilter::noise_gain() const {
  return std::sqrt(std::inner_product(taps.begin(), taps.end(), taps.begin(), 0.0));
}

AntiAliasFilter anti_alias_filter(std::size_t factor) {
  if (factor < 2) throw std::invalid_argument("anti_alias_filter: factor must be above 1");
  // Kaiser's formulas for filter length and window shape, from the ripple and the transition band.
  const double width_rad = 2.0 * std::numbers::pi * kTransitionShare / static_cast<double>(factor);
  const auto half =
      static_cast<std::size_t>(std::ceil((kRippleDb - 7.95) / (2.285 * width_rad) / 2.0));
  const double beta = 0.1102 * (kRippleDb - 8.7);
  AntiAliasFilter filter{factor, {}};
  for (std::size_t i = 0; i <= 2 * half; ++i) {
    const double n = static_cast<double>(i) - static_cast<double>(half);
    const double angle = std::numbers::pi * n / static_cast<double>(factor);
    const double sinc = n == 0.0 ? 1.0 : std::sin(angle) / angle;
    const double place = n / static_cast<double>(half);
    const double window = std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - place * place)) /
                          std::cyl_bessel_i(0.0, beta);
    filter.taps.push_back(sinc * window);
  }
  const double sum = std::accumulate(filter.taps.begin(), filter.taps.end(), 0.0);
  for (double& tap : filter.taps) tap /= sum;
  return filter;
}

std::vector<double> decimated(const std::vector<double>& x, const AntiAliasFilter& filter) {
  const auto half = static_cast<long>(filter.taps.size() / 2);
  const long last = static_cast<long>(x.size()) - 1;
  std::vector<double> result;
  for (std::size_t i = 0; i < x.size(); i += filter.factor) {
    const long first = static_cast<long>(i) - half;
    const bool inner = first >= 0 && static_cast<long>(i) + half <= last;
    double sum = 0.0;
    for (std::size_t j = 0; j < filter.taps.size(); ++j) {
      const long at = first + static_cast<long>(j);
      sum += filter.taps[j] * (inner ? x[static_cast<std::size_t>(at)] : reflected(x, at));
    }
    result.push_back(sum);
  }
  return result;
}

std::vector<double> decimated_hold(const std::vector<double>& x, std::size_t factor) {
  std::vector<double> result;
  for (std::size_t i = 0; i < x.size(); i += factor) {
    const std::size_t end = std::min(i + factor, x.size());
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(i);
    const double sum = std::accumulate(begin, x.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    // Keeps a constant unchanged to the last bit.
    const bool constant = std::all_of(begin, x.begin() + static_cast<std::ptrdiff_t>(end),
                                      [&](double value) { return value == *begin; });
    result.push_back(constant ? *begin : sum / static_cast<double>(end - i));
  }
  return result;
}

std::size_t decimation_factor(const Repeat& repeat, double rate_hz) {
  const auto& t = repeat.time_s;
  if (t.size() < 2) return 1;
  const double dt = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  for (std::size_t i = 0; i < t.size(); ++i)
    if (std::abs(t[i] - t.front() - dt * static_cast<double>(i)) > 0.25 * dt)
      throw std::invalid_argument(
          fmt::format("{} cannot be decimated: its sample times are not equidistant (sample {} at "
                      "{:.9g} s); leave out decimate_to",
                      repeat.source, i, t[i]));
  const double exact = 1.0 / (dt * rate_hz);
  const double factor = std::round(exact);
  if (exact < 1.01) return 1;  // rates that agree within 1 % count as equal
  if (factor >= static_cast<double>(t.size()))
    throw std::invalid_argument(
        fmt::format("{} is sampled at {:.6g} Hz: with decimate_to = {:.6g} Hz only one of its {} "
                    "samples remains; expected a higher rate",
                    repeat.source, 1.0 / dt, rate_hz, t.size()));
  if (factor < 2.0 || std::abs(exact - factor) > 0.01 * factor)
    throw std::invalid_argument(fmt::format(
        "{} is sampled at {:.6g} Hz, which is {:.4g} times decimate_to = {:.6g} Hz; expected a "
        "whole factor, such as {:.6g} Hz or {:.6g} Hz",
        repeat.source, 1.0 / dt, exact, rate_hz, 1.0 / (dt * std::ceil(exact)),
        1.0 / (dt * std::max(1.0, std::floor(exact)))));
  return static_cast<std::size_t>(factor);
}

}  // namespace rigcal::datasets
