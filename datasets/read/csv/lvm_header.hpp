#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/read/csv/csv_text.hpp"

namespace rigcal::datasets {

/// Name of the times in a .lvm, by which they are requested where no column contains them.
inline constexpr std::string_view kLvmTime = "X_Value";

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
  bool first_is_empty = false;      ///< the first column is named X_Value, but has no numbers
};

/// Reads the header of a .lvm above the names of its columns. Returns std::nullopt for any other
/// text.
///
/// @param lines  lines above the names
/// @param separator  separator of the columns
/// @param names  names of the columns
std::optional<LvmHeader> lvm_header(std::span<const std::string> lines, char separator,
                                    std::span<const CsvName> names);

}  // namespace rigcal::datasets
