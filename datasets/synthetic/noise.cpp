#include "datasets/synthetic/noise.hpp"

#include <fmt/format.h>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <stdexcept>

namespace rigcal::datasets {
namespace {

/// Computes the FNV-1a hash, 64 bits, of the bytes of the names. A zero byte ends each name, so
/// that {"ab", "c"} and {"a", "bc"} differ.
std::uint64_t hash_of(std::initializer_list<std::string_view> names) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::string_view name : names) {
    for (const char letter : name) {
      hash ^= static_cast<unsigned char>(letter);
      hash *= kPrime;
    }
    hash *= kPrime;
  }
  return hash;
}

/// Applies SplitMix64, which maps neighbouring seeds to unrelated states.
std::uint64_t mixed(std::uint64_t state) {
  state += 0x9e3779b97f4a7c15;
  state = (state ^ (state >> 30U)) * 0xbf58476d1ce4e5b9;
  state = (state ^ (state >> 27U)) * 0x94d049bb133111eb;
  return state ^ (state >> 31U);
}

}  // namespace

RandomStream random_stream(std::uint64_t seed, std::initializer_list<std::string_view> names) {
  return RandomStream(mixed(mixed(seed) ^ hash_of(names)));
}

double normal(RandomStream& stream, double sd) {
  return sd * boost::random::normal_distribution<double>()(stream);
}

double uniform(RandomStream& stream, double low, double high) {
  return boost::random::uniform_real_distribution<double>(low, high)(stream);
}

std::vector<double> white_noise(RandomStream& stream, std::size_t samples, double sd) {
  boost::random::normal_distribution<double> distribution;
  std::vector<double> noise(samples);
  for (double& value : noise) value = sd * distribution(stream);
  return noise;
}

std::vector<double> ar1_noise(RandomStream& stream, std::size_t samples, double sd,
                              double coefficient) {
  if (!(std::abs(coefficient) < 1.0))
    throw std::invalid_argument(
        fmt::format("ar1_noise: coefficient must be in (-1, 1), is {}", coefficient));
  const double innovation = std::sqrt(1.0 - coefficient * coefficient);
  auto noise = white_noise(stream, samples, sd);
  for (std::size_t i = 1; i < samples; ++i)
    noise[i] = coefficient * noise[i - 1] + innovation * noise[i];
  return noise;
}

double quantised(double value, double step) { return step * std::round(value / step); }

}  // namespace rigcal::datasets
