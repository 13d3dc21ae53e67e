#pragma once

#include <hdf5.h>

#include <optional>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Returns the texts of an attribute, trimmed. The attribute may be a single text or a vector of
/// texts. Empty if there is no such attribute, if it is not a text, or if a text has control
/// characters or more than 40 bytes.
std::vector<std::string> hdf5_texts(hid_t object, const char* attribute);

/// Returns the number in an attribute, of any real type; nullopt unless it contains exactly one.
std::optional<double> hdf5_number(hid_t object, const char* attribute);

/// Returns the numbers in an attribute. Empty if it contains none, or more than 1000; nullopt if
/// there is no such attribute.
std::optional<std::vector<double>> hdf5_numbers(hid_t object, const char* attribute);

}  // namespace rigcal::datasets
