#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Samples at equal distances.
struct RegularTime {
  double start_s = 0.0;
  double step_s = 0.0;  ///< positive
};

/// What the header of LabVIEW's .lvm says about its columns.
struct LvmHeader {
  std::vector<std::string> units;   ///< one per name; empty if there is none
  std::size_t units_line = 0;       ///< line of the units, from 0
  std::optional<RegularTime> time;  ///< set if no column contains the times
};

/// Reads the header of a .lvm above the names of its columns. Returns std::nullopt for any other
/// text.
///
/// @param lines  lines above the names
/// @param separator  separator of the columns
/// @param names  number of names
std::optional<LvmHeader> lvm_header(std::span<const std::string> lines, char separator,
                                    std::size_t names);

}  // namespace rigcal::datasets
