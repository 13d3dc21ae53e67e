#include "report/text/readable.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::report;

TEST_CASE("agreement_text: a rounded zero has no sign", "[report]") {
  CHECK(agreement_text(-0.00001) == "0.0000");
}

TEST_CASE("printed_symbol: letter, subscript and argument", "[report]") {
  const auto parts = [](std::string_view symbol) {
    const PrintedSymbol printed = printed_symbol(symbol);
    return printed.letter + "|" + printed.subscript + "|" + printed.argument;
  };
  CHECK(parts("m") == "m||");
  CHECK(parts("beta") == "β||");
  CHECK(parts("k_sv") == "k|sv|");
  CHECK(parts("tau_hn") == "τ|hn|");
  CHECK(parts("K_dtheta") == "K|dθ|");
  CHECK(parts("P_L(0)") == "P|L|(0)");
  CHECK(parts("omega(0)") == "ω||(0)");
  CHECK(parts("Q_1'") == "Q|1|'");
}
