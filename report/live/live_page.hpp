#pragma once

#include <map>
#include <string>
#include <string_view>

#include "report/json/json_fields.hpp"

namespace rigcal::report {

/// Replaces each {{name}} in a template with the HTML of that name.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& html);

/// Returns the controls and curves of a live model, without the scripts that run them.
///
/// @param noscript  HTML for browsers without scripts
/// @param still     HTML for pictures to show until the model runs
std::string live_html(const std::string& noscript, const std::string& still);

/// Returns the worker, the module and the script, for the end of a page that includes the plot
/// library.
std::string live_scripts(const Json& rig);

}  // namespace rigcal::report
