#pragma once

#include <string>
#include <string_view>

#include "common/readable.hpp"

namespace rigcal::report {

/// A symbol as it is printed in formulas: "k_sv" is k with the subscript "sv".
struct PrintedSymbol {
  std::string letter, subscript;
  std::string argument;  ///< what follows the subscript: "(0)" or "'"
};
/// Splits a symbol, with Greek letters for their names: "tau_v", "C_leak", "P_L(0)", "K_dtheta".
PrintedSymbol printed_symbol(std::string_view symbol);

/// Writes an agreement such as rho2 as a fraction with four decimals. Writes "> 0.9999" for a value
/// that would round to perfect agreement.
std::string agreement_text(double value);

}  // namespace rigcal::report
