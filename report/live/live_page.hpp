#pragma once

#include <map>
#include <string>
#include <string_view>

#include "report/json/json_fields.hpp"

namespace rigcal::report {

/// Replaces each {{name}} of a template by the HTML of that name.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& html);

/// The controls and curves of a live model, without what runs them.
///
/// @param noscript  HTML for browsers without scripts
/// @param still     HTML of pictures that are shown until the model runs
std::string live_html(const std::string& noscript, const std::string& still);

/// The worker, the module and the script, for the end of a page that has the plot library.
std::string live_scripts(const Json& rig);

}  // namespace rigcal::report
