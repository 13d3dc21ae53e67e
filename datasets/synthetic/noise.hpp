#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace rigcal::datasets {

/// Random numbers of one purpose. Boost's generators and distributions, unlike those of the
/// standard library, draw the same numbers on every machine.
using RandomStream = boost::random::mt19937_64;

/// The stream of a seed and names, such as condition, repeat and channel: the same names always
/// draw the same numbers, whatever other streams drew before or beside it.
RandomStream random_stream(std::uint64_t seed, std::initializer_list<std::string_view> names);

/// One draw of N(0, sd^2).
double normal(RandomStream& stream, double sd);

/// One draw, uniform in [low, high).
double uniform(RandomStream& stream, double low, double high);

/// Independent draws of N(0, sd^2), shape (samples).
std::vector<double> white_noise(RandomStream& stream, std::size_t samples, double sd);

/// First-order autoregressive noise n[i] = c n[i-1] + e[i], stationary from its first sample:
/// standard deviation `sd`, autocorrelation c^k. Shape (samples).
///
/// @param coefficient  c, in (-1, 1)
/// @throws std::invalid_argument  coefficient outside (-1, 1)
std::vector<double> ar1_noise(RandomStream& stream, std::size_t samples, double sd,
                              double coefficient);

/// The nearest multiple of `step`, as a converter with this step reads it. Step > 0.
double quantised(double value, double step);

}  // namespace rigcal::datasets
