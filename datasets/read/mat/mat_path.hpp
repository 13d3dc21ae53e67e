#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// One step of a path into a MAT file: a variable or field, and an element of it.
struct MatStep {
  std::string name;
  /// Subscripts from 0, none for a colon; empty: no subscripts.
  std::vector<std::optional<std::size_t>> subscripts;

  bool operator==(const MatStep&) const = default;
};

/// Parses a column in MATLAB's notation: "x", "log.time", "log.signals(2).values(:,1)". Subscripts
/// count from 1; only the last step may have a colon, and only one.
///
/// @throws std::invalid_argument  the problem, in words
std::vector<MatStep> parse_mat_path(const std::string& text);

}  // namespace rigcal::datasets
