#include "datasets/campaign/toml/toml_reader.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::datasets;

TEST_CASE("toml_key: bare where TOML allows it, else quoted", "[datasets]") {
  CHECK(toml_key("warn_rho2") == "warn_rho2");
  CHECK(toml_key("7-B") == "7-B");
  CHECK(toml_key("") == "\"\"");
  CHECK(toml_key("seal A") == "\"seal A\"");
  CHECK(toml_key("0.1") == "\"0.1\"");
  CHECK(toml_key("ü") == "\"ü\"");
}
