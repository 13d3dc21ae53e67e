#pragma once

#include <span>
#include <string_view>

namespace rigcal::datasets {

/// What a word in the name of a column says.
enum class Meaning {
  time,
  // The part that the column plays in a loop.
  reference,
  command,   ///< in the unit of a controlled quantity: its reference; else a valve signal
  valve,     ///< electrical signal of the valve
  electric,  ///< voltage or current, which distinguishes a signal from the position of a spool
  measured,  ///< says only that the quantity was measured
  error,     ///< difference between reference and measurement
  // The quantity.
  position,
  angle,
  force,
  pressure,
  acceleration,
  temperature,
  velocity,
  flow,
  torque,
  rotation,  ///< speed of a shaft
  // Where the quantity is measured.
  side_a,
  side_b,
  supply,
  tank,
  load,
  difference,  ///< between two quantities of one kind
  external,    ///< acts on the rig from outside
  pilot,
  base,
  payload,
  piston,  ///< the piston, or the side of it that has no rod
  spool,   ///< spool of the valve
  filler,  ///< nothing, but other words may be joined to it
};

/// Words of one meaning, in lower case and without the accents of Romance languages.
struct WordRow {
  Meaning meaning;
  std::span<const std::string_view> words;
};

/// Returns the words that names of columns consist of. Words of three letters and more may also be
/// joined, as in "istweg" and "refforce".
std::span<const WordRow> name_words();

/// Symbols of one letter. They count only where no word names the quantity.
struct Symbol {
  char letter;
  Meaning meaning;
};

/// Returns the symbols of quantities: "x", "p".
std::span<const Symbol> quantity_symbols();

/// Returns the symbols behind a pressure: "a" in "pA" and "p_A", "0" in "p0".
std::span<const Symbol> pressure_places();

/// Returns the prefixes that programs of controllers put before a name for its type: "r" in
/// "rPressureA". Other prefixes have no meaning that could mislead.
std::span<const std::string_view> type_prefixes();

}  // namespace rigcal::datasets
