#pragma once

#include <optional>
#include <string>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Guess of a column's meaning from its name alone.
struct ColumnGuess {
  bool is_time = false;
  std::optional<Channel> channel;
  std::string unit;  ///< unit in the name: "mm" of "x_mm", "x [mm]"; else empty
};

/// "t_s", "ref_mm", "x [mm]", "pA_bar_03", "log.time", "u_V": a known word, with a unit behind it
/// in brackets or between underscores.
ColumnGuess guess_column(const std::string& name);

/// Guesses the channel of a column from its unit, if its name means nothing.
///
/// @param has_position  whether another column is the position; a second length is then its
///                      reference
std::optional<Channel> guess_by_unit(const std::string& unit, bool has_position);

}  // namespace rigcal::datasets
