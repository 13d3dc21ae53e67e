#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Inserts the missing samples of a repeat if the campaign bridges holes (`holes = "bridge"`);
/// otherwise does nothing. A time step between 1.5 times the median and `longest_hole` is filled
/// with as many evenly spaced samples as are missing. These are marked as `bridged` and are never
/// compared with the model. Their values only keep filters and shifts working. They are
/// interpolated linearly or, for an input that is constant between samples, repeated.
///
/// @throws InputError  if more samples are missing than the record has
void bridge_holes(const Campaign& campaign, Repeat& repeat);

/// Sets the values that shifted() computed from bridged samples to NaN.
///
/// @param row  result of shifted(values, shift, ...)
void forget_bridged(std::vector<double>& row, const std::vector<bool>& bridged, double shift);

/// Describes the bridged holes, one text per repeat.
std::vector<std::string> bridged_notes(const std::vector<Repeat>& repeats);

/// Returns a warning if a hole in a recorded drive is bridged in all repeats; empty otherwise.
std::string guessed_drive_warning(const Campaign& campaign, const Condition& condition,
                                  const Record& record);

}  // namespace rigcal::datasets
