#include "datasets/campaign/condition_id.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace rigcal::datasets {

TEST_CASE("condition_id: names a file of its own folder, whatever stands in it", "[datasets]") {
  for (const char* id : {"sine", "sine_2.5-Hz", "...", "-", "A"}) CHECK(is_condition_id(id));
  for (const char* id :
       {"", ".", "..", "a/b", "../a", "/a", "a\\b", "a b", "a\n", "\xc3\xa9", "a:b"})
    CHECK_FALSE(is_condition_id(id));
  CHECK_FALSE(is_condition_id(std::string("a\0b", 3)));
  CHECK(is_condition_id(std::string(200, 'a')));
  CHECK_FALSE(is_condition_id(std::string(201, 'a')));
}

}  // namespace rigcal::datasets
