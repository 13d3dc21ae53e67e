#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// What `ColumnGuess::other` says of the position of a valve's spool.
inline constexpr std::string_view kSpoolPosition = "the position of a spool";

/// Returns true if values in this unit can be converted to `to`. False if `unit` is empty.
bool converts_to(const std::string& unit, std::string_view to);

/// Meaning of a column, guessed from its name and unit.
struct ColumnGuess {
  bool is_time = false;
  std::optional<Channel> channel;
  /// Unit that the file gives, or else that in the name: "mm" in "x_mm" and "x [mm]"; else empty.
  std::string unit;
  /// Whether a force or torque acts on the rig from outside, rather than between its parts.
  bool is_external_load = false;
  /// What the column contains if that is known but no channel: "a velocity". Else empty.
  std::string_view other{};
};

/// Guesses from names such as "t_s", "x_cmd_mm", "x [mm]", "pA_bar_03", "log.time" and
/// "Sollkraft_kN". Words of the name give the quantity, its place and its part in a loop
/// (name_words.hpp). The unit decides about the quantity where it contradicts them.
///
/// @param unit  given by the file separately from the name; may be empty
ColumnGuess guess_column(const std::string& name, const std::string& unit = {});

/// Guesses the channel of a column from its unit alone.
///
/// @param taken  channels that other columns have: a second length is a reference, a second
///               pressure that of the other chamber
/// @return  std::nullopt if no channel has the unit, or if all that have it are taken
std::optional<Channel> guess_by_unit(const std::string& unit, std::span<const Channel> taken);

}  // namespace rigcal::datasets
