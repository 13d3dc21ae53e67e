#include "datasets/campaign/report_settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/quantity.hpp"

namespace rigcal::datasets {
namespace {

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Removes a number from the front of a text, and returns it.
std::optional<double> take_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// Removes a word or sign, with the spaces around it, from the front of a text. Returns false if
/// the text does not begin with it.
bool take(std::string_view& text, std::string_view word) {
  text = without_blanks(text);
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  text = without_blanks(text);
  return true;
}

/// Removes the coverage factor "(k = 2)" from the end of a text, and returns it.
std::optional<double> take_coverage_factor(std::string_view& text) {
  const auto open = text.rfind('(');
  if (open == std::string_view::npos) return std::nullopt;
  std::string_view rest = text.substr(open);
  if (!take(rest, "(") || !take(rest, "k") || !take(rest, "=")) return std::nullopt;
  const auto factor = take_number(rest);
  if (!factor || !(*factor > 0.0) || !take(rest, ")") || !rest.empty()) return std::nullopt;
  text = without_blanks(text.substr(0, open));
  return factor;
}

}  // namespace

std::string text_of(const ReportSettings::Fields& fields, std::string_view key) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const auto& field) { return field.first == key; });
  return found == fields.end() ? std::string() : found->second;
}

StatedUncertainty stated_uncertainty(std::string_view text, std::string_view unit) {
  StatedUncertainty result;
  const auto factor = take_coverage_factor(text);
  const auto expanded = factor ? take_number(text) : std::nullopt;
  const std::string_view of = without_blanks(text);
  if (!expanded || !(*expanded >= 0.0) || of.empty()) {
    result.problem = "expected \"NUMBER UNIT (k = N)\" or \"NUMBER % (k = N)\"";
    return result;
  }
  const double standard = *expanded / *factor;
  if (of == "%") {
    result.gain_sd = standard / 100.0;
    return result;
  }
  try {
    result.offset_sd = unit_conversion(of, unit).scale * standard;
  } catch (const QuantityError& error) {
    result.problem = error.what();
  }
  return result;
}

}  // namespace rigcal::datasets
