#include <array>
#include <cmath>

#include "common/quantity.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;

/// A text is either rejected or read as a finite number with the expected unit.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kUnits{"Pa", "m", "kg", "N s/m", "m^3", "K", "1", "rad/s", "V"};
  if (size == 0) return 0;
  const char* unit = kUnits[data[0] % kUnits.size()];
  try {
    fuzz::require(std::isfinite(parse_quantity(fuzz::text_of_bytes(data + 1, size - 1), unit)),
                  "a quantity is finite");
  } catch (const QuantityError&) {
  }
  return 0;
}
