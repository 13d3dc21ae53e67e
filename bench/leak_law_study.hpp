#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace rigcal::bench {

/// Seeds of the campaigns to run, and the file that keeps their counts.
struct StudyRange {
  std::uint64_t first = 1, last = 1;  ///< seeds; one campaign each
  int threads = 1;
  std::string file;  ///< kept_counts.hpp; empty: nothing is stored
};

/// Prints how often small leaks are found on the day of the reference, in a cylinder with
/// two chambers whose position and pressures are recorded. The leak is laminar or through an
/// orifice, and is fitted by either law.
///
/// @param only  part of the names of the rows to be studied
void study_leak_laws(const StudyRange& range, const std::string& only);

/// Prints the same for the laminar leaks in records of another simulator
/// (shared/data/sim_hopsan_leaky_servo), to which noise is added.
///
/// @param folder  folder of the records
void study_other_simulator(const std::filesystem::path& folder, const StudyRange& range);

}  // namespace rigcal::bench
