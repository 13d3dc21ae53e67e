#include "report/live/live_page.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "report/document/assets.hpp"
#include "report/figure/decimate.hpp"
#include "report/live/live_module.hpp"

namespace rigcal::report {
namespace {

/// Formats JSON so that no HTML parser can mistake it for markup.
std::string for_script(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

std::string module_base64() {
  const std::string_view module = live_module();
  return base64(std::vector<std::uint8_t>(module.begin(), module.end()));
}

}  // namespace

/// Replaces each {{name}} in a template with the HTML of that name.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& html) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = std::min(text.find("{{", at), text.size());
    result += text.substr(at, open - at);
    if (open == text.size()) break;
    const std::size_t close = text.find("}}", open);
    result += html.at(text.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  return result;
}

std::string live_html(const std::string& noscript, const std::string& still) {
  return filled(asset("live.html"), {{"noscript", noscript}, {"still", still}});
}

std::string live_scripts(const Json& rig) {
  return "<script type=\"text/plain\" id=\"live-worker\">" + std::string(asset("live_worker.js")) +
         "</script>\n<script type=\"application/json\" id=\"live-rig\">" + for_script(rig) +
         "</script>\n<script type=\"text/plain\" id=\"live-module\">" + module_base64() +
         "</script>\n<script>" + std::string(asset("live.js")) + "</script>\n";
}

}  // namespace rigcal::report
