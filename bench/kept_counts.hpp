#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace rigcal::bench {

/// Stores the counts of the campaigns so far in a text file (name of the row, seed, counts), so
/// that a study that was stopped can continue. Thread-safe.
///
/// @tparam Counts  has a member `for_each` that calls its argument with a reference to each count
template <typename Counts>
class KeptCounts {
 public:
  /// @param file  path of the text file; empty if nothing is to be stored
  explicit KeptCounts(std::string file) : file_(std::move(file)) {
    std::ifstream in(file_);
    std::string line;
    while (std::getline(in, line)) {
      const auto bar = line.find('|');
      if (bar == std::string::npos) continue;
      std::istringstream numbers(line.substr(bar + 1));
      std::uint64_t seed = 0;
      Counts counts;
      numbers >> seed;
      counts.for_each([&](auto& each) { numbers >> each; });
      if (numbers) kept_[line.substr(0, bar)][seed] = counts;
    }
  }

  /// Returns the counts of one campaign of a row; `make` counts them if the file lacks them.
  template <typename Make>
  Counts of(const std::string& row, std::uint64_t seed, Make make) {
    {
      const std::lock_guard lock(mutex_);
      const auto& own = kept_[row];
      const auto found = own.find(seed);
      if (found != own.end()) return found->second;
    }
    Counts counts = make(seed);
    if (file_.empty()) return counts;
    std::string line = fmt::format("{}|{}", row, seed);
    counts.for_each([&](auto& each) { line += fmt::format(" {}", each); });
    const std::lock_guard lock(mutex_);
    std::ofstream(file_, std::ios::app) << line << "\n";
    return counts;
  }

 private:
  std::string file_;
  std::map<std::string, std::map<std::uint64_t, Counts>> kept_;
  std::mutex mutex_;
};

/// Formats a rate in percent, with its standard error estimated from the variation between
/// campaigns.
template <typename Counts>
std::string rate_of(const std::vector<Counts>& all, int Counts::*hits, int Counts::*trials) {
  double hit = 0.0;
  double tried = 0.0;
  for (const Counts& each : all) {
    hit += each.*hits;
    tried += each.*trials;
  }
  if (tried == 0.0) return "-";
  const double rate = hit / tried;
  double squares = 0.0;
  for (const Counts& each : all) squares += std::pow(each.*hits - rate * each.*trials, 2);
  return fmt::format("{:.1f} +- {:.1f} ({:.0f} of {:.0f})", 100.0 * rate,
                     100.0 * std::sqrt(squares) / tried, hit, tried);
}

}  // namespace rigcal::bench
