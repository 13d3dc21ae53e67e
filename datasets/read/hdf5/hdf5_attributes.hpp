#pragma once

#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Texts of an attribute, trimmed: one, or those of a vector. None if there is no such attribute,
/// if it is no text, or if a text is longer than 40 bytes or has control characters.
std::vector<std::string> hdf5_texts(hid_t object, const char* attribute);

/// A number of an attribute, of any real type; nothing if there is no such attribute.
std::optional<double> hdf5_number(hid_t object, const char* attribute);

/// Reads the numbers of an attribute, at most 1000. Empty if it has no numbers; nothing if there is
/// no such attribute.
std::optional<std::vector<double>> hdf5_numbers(hid_t object, const char* attribute);

}  // namespace rigcal::datasets
