#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// One step of a path into a MAT file: a variable or field, and the element selected in it.
struct MatStep {
  std::string name;
  /// Subscripts from 0, nullopt for a colon. Empty if there are no subscripts.
  std::vector<std::optional<std::size_t>> subscripts;

  bool operator==(const MatStep&) const = default;
};

/// Parses the name of a column in MATLAB's notation: "x", "log.time", "log.signals(2).values(:,1)".
/// Subscripts count from 1. Only the last step may have a colon, and only one.
///
/// @throws std::invalid_argument  if the text is not such a name; what() describes the problem
std::vector<MatStep> parse_mat_path(const std::string& text);

}  // namespace rigcal::datasets
