#include "calib/trust/unit_product.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace rigcal::calib {
namespace {

constexpr std::array<std::string_view, 5> kBase{"kg", "m", "s", "V", "K"};
using Exponents = std::array<double, kBase.size()>;

struct Symbol {
  std::string_view name;
  Exponents exponents;
};
constexpr std::array kSymbols{
    Symbol{"kg", {1, 0, 0, 0, 0}},   Symbol{"m", {0, 1, 0, 0, 0}},   Symbol{"s", {0, 0, 1, 0, 0}},
    Symbol{"V", {0, 0, 0, 1, 0}},    Symbol{"K", {0, 0, 0, 0, 1}},   Symbol{"N", {1, 1, -2, 0, 0}},
    Symbol{"Pa", {1, -1, -2, 0, 0}}, Symbol{"rad", {0, 0, 0, 0, 0}}, Symbol{"", {0, 0, 0, 0, 0}},
};

Exponents exponents_of(std::string_view unit) {
  Exponents total{};
  double sign = 1.0;
  std::size_t at = 0;
  while (at < unit.size()) {
    if (unit[at] == '/') sign = -1.0;
    if (unit[at] == '/' || unit[at] == ' ' || unit[at] == '(' || unit[at] == ')') {
      ++at;
      continue;
    }
    std::string name;
    while (at < unit.size() && std::isalpha(static_cast<unsigned char>(unit[at])) != 0)
      name += unit[at++];
    std::string digits;
    while (at < unit.size() && std::isdigit(static_cast<unsigned char>(unit[at])) != 0)
      digits += unit[at++];
    const Symbol* found = nullptr;
    for (const Symbol& symbol : kSymbols) {
      if (symbol.name == name) found = &symbol;
    }
    if (found == nullptr || (name.empty() && digits != "1"))
      throw std::invalid_argument(fmt::format("unit_product: unknown unit '{}'", unit));
    const double power = digits.empty() ? 1.0 : std::stod(digits);
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += sign * power * found->exponents[i];
  }
  return total;
}

std::string text_of(std::string_view name, double exponent) {
  if (exponent == 1.0) return std::string(name);
  return exponent == std::round(exponent) ? fmt::format("{}{:g}", name, exponent)
                                          : fmt::format("{}^{:g}", name, exponent);
}

}  // namespace

std::string unit_product(std::string_view a, std::string_view b, double power) {
  const Exponents first = exponents_of(a);
  const Exponents second = exponents_of(b);
  std::string above;
  std::string below;
  for (std::size_t i = 0; i < kBase.size(); ++i) {
    const double exponent = first[i] + power * second[i];
    if (std::abs(exponent) < 1e-9) continue;
    std::string& side = exponent > 0.0 ? above : below;
    if (!side.empty()) side += ' ';
    side += text_of(kBase[i], std::abs(exponent));
  }
  if (below.empty()) return above.empty() ? "1" : above;
  const bool several = below.find(' ') != std::string::npos;
  return fmt::format("{}/{}", above.empty() ? "1" : above, several ? "(" + below + ")" : below);
}

static_assert(kBase.front() == "kg");
double mass_exponent(std::string_view unit) { return exponents_of(unit).front(); }

}  // namespace rigcal::calib
