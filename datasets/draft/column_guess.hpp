#pragma once

#include <optional>
#include <string>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Meaning of a column, guessed only from its name.
struct ColumnGuess {
  bool is_time = false;
  std::optional<Channel> channel;
  std::string unit;  ///< unit in the name: "mm" in "x_mm" and "x [mm]"; else empty
};

/// Guesses from names such as "t_s", "ref_mm", "x [mm]", "pA_bar_03", "log.time" and "u_V": a known
/// word, followed by a unit in brackets or between underscores.
ColumnGuess guess_column(const std::string& name);

/// Guesses the channel of a column from its unit, if the name is not recognised.
///
/// @param has_position  whether another column is the position, so that a second length is its
///                      reference
std::optional<Channel> guess_by_unit(const std::string& unit, bool has_position);

}  // namespace rigcal::datasets
