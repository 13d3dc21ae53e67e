#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Inserts the missing samples of a repeat if the campaign bridges holes (`holes = "bridge"`). A
/// step of time between 1.5 times the median and `longest_hole` gets as many evenly spaced samples
/// as are missing. They are marked as `bridged` and are compared with nothing. Their values, a line
/// between the neighbours or a constant input, only keep filters and shifts going. Does nothing if
/// the campaign does not bridge holes.
///
/// @throws InputError  more samples are missing than the record has
void bridge_holes(const Campaign& campaign, Repeat& repeat);

/// Sets the values that shifted() made from bridged samples to NaN.
///
/// @param row    result of shifted(values, shift, ...)
void forget_bridged(std::vector<double>& row, const std::vector<bool>& bridged, double shift);

/// Describes the bridged holes, one text per repeat.
std::vector<std::string> bridged_notes(const std::vector<Repeat>& repeats);

/// Warns, in words, if a hole of a recorded drive is bridged in all repeats; empty otherwise.
std::string guessed_drive_warning(const Campaign& campaign, const Condition& condition,
                                  const Record& record);

}  // namespace rigcal::datasets
