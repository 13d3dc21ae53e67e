#include "report/store/validity.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Fraction of a bound by which a range may exceed the covered range before it is reported.
constexpr double kSlack = 0.1;

void compare(std::vector<std::string>& result, std::string_view what, std::string_view unit,
             const std::optional<Range>& asked, const std::optional<Range>& covered,
             const std::optional<Range>& validated) {
  if (!asked || !covered) return;
  const bool below = asked->low < covered->low - kSlack * std::abs(covered->low);
  const bool above = asked->high > covered->high + kSlack * std::abs(covered->high);
  if (!below && !above) return;
  result.push_back(
      fmt::format("{} {} is used, but the fit covers only {}{}", what, in_words(*asked, unit),
                  in_words(*covered, unit),
                  validated ? fmt::format(", validated at {}", in_words(*validated, unit)) : ""));
}

}  // namespace

std::string in_words(const Range& range, std::string_view unit) {
  const ReadableUnit readable = readable_unit(range.high, unit);
  const auto number = [&](double value) { return fmt::format("{:.4g}", value / readable.si); };
  const std::string low = number(range.low);
  const std::string high = number(range.high);
  const std::string suffix = readable.name.empty() ? "" : fmt::format(" {}", readable.name);
  return low == high ? high + suffix : fmt::format("{} to {}{}", low, high, suffix);
}

std::vector<std::string> outside(const calib::Validity& asked, const calib::Validity& covered,
                                 const calib::Validity* validated) {
  std::vector<std::string> result;
  const auto add = [&](std::optional<Range> calib::Validity::*range, std::string_view what,
                       std::string_view unit) {
    compare(result, what, unit, asked.*range, covered.*range,
            validated != nullptr ? validated->*range : std::nullopt);
  };
  add(&calib::Validity::frequency_hz, "frequency", "Hz");
  const auto [amplitude, unit] = asked.amplitude();
  compare(result, "amplitude", unit, amplitude, covered.amplitude().range,
          validated != nullptr ? validated->amplitude().range : std::nullopt);
  add(&calib::Validity::supply_pressure_pa, "supply pressure", "Pa");
  add(&calib::Validity::leakage_coefficient, "leakage coefficient", "1");
  return result;
}

}  // namespace rigcal::report
