#include "report/text/gathered_warnings.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::report;
using Lines = std::vector<std::string>;

TEST_CASE("gathered_by_text: each text once, with all of a few records", "[report]") {
  CHECK(gathered_by_text({}).empty());
  CHECK(gathered_by_text({{"a", "late"}, {"b", "short"}, {"c", "late"}}) ==
        Lines{"a, c: late", "b: short"});
  CHECK(gathered_by_text({{"a", "x"}, {"b", "x"}, {"c", "x"}}) == Lines{"a, b, c: x"});
}

TEST_CASE("gathered_by_text: of many records their number and the first", "[report]") {
  CHECK(gathered_by_text({{"a", "x"}, {"b", "x"}, {"c", "x"}, {"d", "x"}, {"e", "x"}}) ==
        Lines{"5 records (a, b, c and 2 more): x"});
}
