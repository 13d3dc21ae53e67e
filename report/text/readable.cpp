#include "report/text/readable.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/significant.hpp"

namespace rigcal::report {
namespace {

struct Greek {
  std::string_view name, letter;
};
/// Returns the Greek letter whose name the text begins with; both are empty if there is none.
Greek greek_at(std::string_view text) {
  constexpr std::array kGreek{Greek{"alpha", "α"}, Greek{"beta", "β"},  Greek{"zeta", "ζ"},
                              Greek{"theta", "θ"}, Greek{"kappa", "κ"}, Greek{"lambda", "λ"},
                              Greek{"mu", "µ"},    Greek{"rho", "ρ"},   Greek{"sigma", "σ"},
                              Greek{"tau", "τ"},   Greek{"psi", "ψ"},   Greek{"omega", "ω"},
                              Greek{"eps", "ε"}};
  for (const Greek& each : kGreek)
    if (text.starts_with(each.name)) return each;
  return {};
}

std::string with_greek(std::string_view text) {
  std::string printed;
  while (!text.empty()) {
    const Greek found = greek_at(text);
    printed += found.name.empty() ? text.substr(0, 1) : found.letter;
    text.remove_prefix(found.name.empty() ? 1 : found.name.size());
  }
  return printed;
}

}  // namespace

PrintedSymbol printed_symbol(std::string_view symbol) {
  const std::size_t argument = std::min(symbol.find_first_of("('"), symbol.size());
  const std::string_view name = symbol.substr(0, argument);
  const std::size_t split = std::min(name.find('_'), name.size());
  PrintedSymbol printed{
      with_greek(name.substr(0, split)), {}, std::string(symbol.substr(argument))};
  if (split < name.size()) printed.subscript = with_greek(name.substr(split + 1));
  return printed;
}

std::string agreement_text(double value) {
  const std::string text = fixed(value, 4);
  return text == "1.0000" && value < 1.0 ? std::string("> 0.9999") : text;
}

}  // namespace rigcal::report
