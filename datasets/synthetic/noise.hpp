#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace rigcal::datasets {

/// Random numbers for one purpose. Unlike those of the standard library, Boost's generators and
/// distributions produce the same numbers on every machine.
using RandomStream = boost::random::mt19937_64;

/// Returns the stream for a seed and names, such as condition, repeat and channel. The same names
/// always produce the same numbers, whatever other streams have produced.
RandomStream random_stream(std::uint64_t seed, std::initializer_list<std::string_view> names);

/// Draws a number from N(0, sd^2).
double normal(RandomStream& stream, double sd);

/// Draws a number uniformly from [low, high).
double uniform(RandomStream& stream, double low, double high);

/// Draws independent numbers from N(0, sd^2), shape (samples).
std::vector<double> white_noise(RandomStream& stream, std::size_t samples, double sd);

/// Draws first-order autoregressive noise n[i] = c n[i-1] + e[i]. It is stationary from its first
/// sample, with standard deviation `sd` and autocorrelation c^k. Shape (samples).
///
/// @param coefficient  c, in (-1, 1)
/// @throws std::invalid_argument  if the coefficient is outside (-1, 1)
std::vector<double> ar1_noise(RandomStream& stream, std::size_t samples, double sd,
                              double coefficient);

/// Rounds to the nearest multiple of `step`, as a converter with this step does. Step > 0.
double quantised(double value, double step);

}  // namespace rigcal::datasets
