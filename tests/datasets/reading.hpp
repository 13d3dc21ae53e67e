#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/record_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {

using Numbers = std::vector<double>;
using Table = std::vector<Numbers>;

/// Returns the error message of `read`, or "no error" if it accepts the file.
template <typename Read>
std::string message_when(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Reads columns of a file, using the reader for its format.
inline Table read_columns(const std::filesystem::path& path,
                          const std::vector<std::string>& columns, const std::string& time = "") {
  return datasets::record_reader(path).load(path, {columns, time}).columns;
}

inline std::string read_refusal(const std::filesystem::path& path,
                                const std::vector<std::string>& columns,
                                const std::string& time = "") {
  return message_when([&] { read_columns(path, columns, time); });
}

inline bool all_finite(const Table& columns) {
  for (const Numbers& column : columns)
    for (const double value : column)
      if (!std::isfinite(value)) return false;
  return true;
}

enum class Ending { values, refused, other };

/// Outcome of reading a file that may be damaged: finite numbers, a refusal in one line that names
/// the file, or neither, which is a defect.
///
/// @param read  returns whether everything it reads is finite
template <typename Read>
Ending ending_of(const std::filesystem::path& path, const Read& read) {
  try {
    return read() ? Ending::values : Ending::other;
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool has_words = message.size() > path.string().size() + 10 &&
                           message.starts_with(path.string() + ": ") &&
                           message.find('\n') == std::string::npos;
    return has_words ? Ending::refused : Ending::other;
  }
}

struct Endings {
  std::size_t values = 0;
  std::size_t refused = 0;
};

/// Reads a file with every `step`-th byte changed in several ways, and counts the outcomes.
///
/// @param name    name of the damaged file, whose extension selects the format
/// @param ending  reads a file: Ending(path)
template <typename Read>
Endings damage(const TemporaryFolder& folder, const std::string& name, const std::string& whole,
               std::size_t step, const std::vector<unsigned char>& changes, const Read& ending) {
  Endings count;
  for (std::size_t at = 0; at < whole.size(); at += step) {
    for (const unsigned char change : changes) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ change);
      std::filesystem::remove(folder / name);  // overwriting it would wait for the disk
      const Ending found = ending(folder.write(name, damaged));
      if (found == Ending::other) FAIL_CHECK("byte " << at << " changed by " << int{change});
      count.values += found == Ending::values ? 1 : 0;
      count.refused += found == Ending::refused ? 1 : 0;
    }
  }
  return count;
}

}  // namespace rigcal::test
