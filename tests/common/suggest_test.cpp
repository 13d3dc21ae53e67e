#include "common/suggest.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using Catch::Contains;
using Catch::Matchers::EndsWith;
using rigcal::nearest_name;
using rigcal::unknown_name_message;

namespace {
const std::vector<std::string> kKeys{"mass", "damping", "stiffness", "bulk_modulus", "kp", "ki"};
}

TEST_CASE("nearest_name: finds slips of the pen", "[common]") {
  CHECK(nearest_name("mas", kKeys) == "mass");         // omission
  CHECK(nearest_name("masss", kKeys) == "mass");       // insertion
  CHECK(nearest_name("dampimg", kKeys) == "damping");  // substitution
  CHECK(nearest_name("dmaping", kKeys) == "damping");  // transposition
  CHECK(nearest_name("Mass", kKeys) == "mass");        // case
  CHECK(nearest_name("bulk modulus", kKeys) == "bulk_modulus");
  CHECK(nearest_name("mass", kKeys) == "mass");
}

TEST_CASE("nearest_name: the exchange of neighbours is one slip", "[common]") {
  CHECK(nearest_name("pk", {"kp"}) == "kp");
}

TEST_CASE("nearest_name: nothing is near", "[common]") {
  CHECK(nearest_name("temperature", kKeys).empty());
  CHECK(nearest_name("x", {"y", "zz"}).empty());
  CHECK(nearest_name("", kKeys).empty());
  CHECK(nearest_name("mass", {}).empty());
}

TEST_CASE("nearest_name: takes the nearest, the first among equals", "[common]") {
  CHECK(nearest_name("position", {"position_c", "positions", "posit"}) == "positions");
  CHECK(nearest_name("kd", {"kp", "ki"}) == "kp");
}

TEST_CASE("unknown_name_message: proposes and lists", "[common]") {
  CHECK(unknown_name_message("key", "nmae", {"name", "mass"}) ==
        "unknown key 'nmae'; did you mean 'name'? (known: name, mass)");
  CHECK(unknown_name_message("key", "temperature", {"name", "mass"}) ==
        "unknown key 'temperature' (known: name, mass)");
  CHECK(unknown_name_message("key", "name", {}) == "unknown key 'name'");
}

TEST_CASE("unknown_name_message: cuts long lists short, but searches them all", "[common]") {
  std::vector<std::string> many;
  for (int i = 0; i < 100; ++i) many.push_back("column_" + std::to_string(i));
  many.emplace_back("pressure");
  const std::string message = unknown_name_message("column", "presure", many);
  CHECK_THAT(message, Contains("'pressure'?") && EndsWith("column_29 and 71 more)"));
}

TEST_CASE("nearest_name: a third of the letters may be wrong", "[common]") {
  const std::vector<std::string> known{"abcdefghi"};
  CHECK(nearest_name("abcdefxyz", known) == "abcdefghi");
  CHECK(nearest_name("abcdewxyz", known).empty());
}
