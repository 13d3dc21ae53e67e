#pragma once

#include <toml++/toml.h>

#include <string>

namespace rigcal::datasets {

/// A TOML document in the order of the file from which the table was read; added keys come last.
/// toml++'s own formatter sorts keys by name and breaks keys with a line break.
std::string toml_text(const toml::table& root);

}  // namespace rigcal::datasets
