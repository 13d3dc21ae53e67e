#pragma once

#include <toml++/toml.h>

#include <string>

namespace rigcal::datasets {

/// A TOML document in the order of the file that the table was read from; what was added comes
/// last. toml++'s own formatter sorts keys by name and breaks keys that hold a newline.
std::string toml_text(const toml::table& root);

}  // namespace rigcal::datasets
