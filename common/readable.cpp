#include "common/readable.hpp"

#include <array>
#include <cmath>

#include "common/significant.hpp"

namespace rigcal {
namespace {

struct Relative {
  std::string_view si_unit;
  std::string_view name;
  double si;
};

/// Sorted by decreasing size within each SI unit. The last unit also applies to smaller values.
constexpr std::array kRelatives{
    Relative{"Pa", "GPa", 1e9},    Relative{"Pa", "MPa", 1e6},
    Relative{"Pa", "kPa", 1e3},    Relative{"Pa", "Pa", 1.0},
    Relative{"m", "m", 1.0},       Relative{"m", "mm", 1e-3},
    Relative{"m", "um", 1e-6},     Relative{"m2", "cm2", 1e-4},
    Relative{"m2", "mm2", 1e-6},   Relative{"m3", "L", 1e-3},
    Relative{"m3", "cm3", 1e-6},   Relative{"m3/s", "L/min", 1e-3 / 60.0},
    Relative{"s", "s", 1.0},       Relative{"s", "ms", 1e-3},
    Relative{"m/V", "m/V", 1.0},   Relative{"m/V", "mm/V", 1e-3},
    Relative{"m/V", "um/V", 1e-6}, Relative{"N", "kN", 1e3},
    Relative{"N", "N", 1.0},       Relative{"m/s", "m/s", 1.0},
    Relative{"m/s", "mm/s", 1e-3}, Relative{"V", "V", 1.0},
    Relative{"V", "mV", 1e-3},     Relative{"rad", "deg", 3.141592653589793 / 180.0},
};

}  // namespace

std::string typographic(std::string_view unit) {
  constexpr std::array kRaised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool begins = i == 0 || !is_letter(unit[i - 1]);
    const bool precedes_letter = i + 1 < unit.size() && is_letter(unit[i + 1]);
    const bool is_power = i > 0 && is_letter(unit[i - 1]) && unit[i] >= '0' && unit[i] <= '9';
    if (unit[i] == 'u' && begins && precedes_letter) {
      text += "µ";
    } else if (is_power) {
      text += kRaised[static_cast<std::size_t>(unit[i] - '0')];
    } else {
      text += unit[i];
    }
  }
  return text;
}

ReadableUnit readable_unit(double value_si, std::string_view si_unit) {
  ReadableUnit found{si_unit == "1" ? std::string() : typographic(si_unit), 1.0};
  for (const Relative& relative : kRelatives) {
    if (relative.si_unit != si_unit) continue;
    // Zero has no magnitude to choose a prefix for.
    if (value_si == 0.0) return {typographic(si_unit), 1.0};
    found = {typographic(relative.name), relative.si};
    if (std::abs(value_si) >= 0.9999999 * found.si) break;
  }
  return found;
}

std::string readable(double value_si, std::string_view si_unit, int digits) {
  if (!std::isfinite(value_si)) return "-";
  const ReadableUnit unit = readable_unit(value_si, si_unit);
  std::string text = significant(value_si / unit.si, digits);
  if (!unit.name.empty()) text.append(" ").append(unit.name);
  return text;
}

}  // namespace rigcal
