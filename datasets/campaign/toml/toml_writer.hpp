#pragma once

#include <toml++/toml.h>

#include <string>

namespace rigcal::datasets {

/// Writes a TOML document in the order of the file from which the table was read; added keys come
/// last. The formatter in toml++ sorts keys by name, and writes keys with line breaks incorrectly.
std::string toml_text(const toml::table& root);

}  // namespace rigcal::datasets
