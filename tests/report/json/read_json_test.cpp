#include "report/json/read_json.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "common/error.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Contains;
using rigcal::InputError;
using rigcal::report::Json;
using rigcal::report::JsonLimits;
using rigcal::report::parse_json;
using rigcal::report::read_json;

namespace {

Json parsed_as(const std::string& text, const JsonLimits& limits = {}) {
  return parse_json(text, "f.json", limits);
}

}  // namespace

TEST_CASE("read_json: every kind of value, with brackets and quotes within texts", "[report]") {
  const Json json =
      parsed_as(R"({"a": [1, -2.5e3, 1e-999, true, null], "b": "[{\"\\", "c": {"d": ":,"}})");
  CHECK(json.at("a").at(1) == -2500.0);
  CHECK(json.at("a").at(2) == 0.0);  // a number too small for a double becomes zero
  CHECK(json.at("b") == "[{\"\\");
  CHECK(json.at("c").at("d") == ":,");
  // After an escaped quote, brackets are still text.
  JsonLimits limits;
  limits.depth = 1;
  CHECK(parsed_as(R"(["\"[[["])", limits).at(0) == "\"[[[");
}

TEST_CASE("read_json: the place of what is no JSON", "[report]") {
  CHECK_THROWS_WITH(parsed_as("{\n  \"a\": nan\n}"), Contains("f.json:2:9: this is not JSON"));
  CHECK_THROWS_WITH(parsed_as(""), Contains("f.json:1:1: "));
  CHECK_THROWS_AS(parsed_as("{\"a\": 1"), InputError);
  CHECK_THROWS_AS(parsed_as("[1] 2"), InputError);
  CHECK_THROWS_AS(parsed_as("\"unfinished \\"), InputError);
  CHECK_THROWS_AS(parsed_as(std::string("[1\0]", 4)), InputError);
}

TEST_CASE("read_json: a number beyond the range of a double", "[report]") {
  CHECK_THROWS_WITH(parsed_as("{\"a\":\n [1, -1e999]}"),
                    Contains("f.json:2:6: the number -1e999 is too large"));
  CHECK_THROWS_WITH(parsed_as("[1,\n 4.57e299]"),
                    Contains("f.json:2:2: the number 4.57e299 is too large"));
  CHECK(parsed_as("[1e149, -1e149]").size() == 2);
  // These numbers are too large because of their digits, not their exponent.
  CHECK_THROWS_AS(parsed_as("[1" + std::string(400, '0') + "]"), InputError);
  CHECK_THROWS_AS(parsed_as("[1" + std::string(400, '0') + "e-1]"), InputError);
  CHECK(parsed_as("[0." + std::string(400, '0') + "1]").at(0) == 0.0);
  JsonLimits any;
  any.number = std::numeric_limits<double>::max();
  CHECK(parsed_as("[1.7976931348623157e308]", any).at(0) == 1.7976931348623157e308);
}

TEST_CASE("read_json: each limit, kept and broken by one", "[report]") {
  const auto brackets = [](int n) {
    return std::string(static_cast<std::size_t>(n), '[') +
           std::string(static_cast<std::size_t>(n), ']');
  };
  JsonLimits limits;
  limits.depth = 3;
  CHECK_NOTHROW(parsed_as(brackets(3), limits));
  CHECK_THROWS_WITH(parsed_as(brackets(4), limits),
                    Contains("f.json:1:4: brackets nested more than 3 deep"));
  limits = {};
  limits.values = 4;
  CHECK_NOTHROW(parsed_as("[1, 2, 3]", limits));
  CHECK_THROWS_WITH(parsed_as("[1, 2, 3, 4]", limits), Contains("more than 4 values"));
  limits = {};
  limits.bytes = 3;
  CHECK_NOTHROW(parsed_as("[1]", limits));
  CHECK_THROWS_WITH(parsed_as("[12]", limits), Contains("has 4 bytes"));
  limits = {};
  limits.key_comparisons = 8;  // two objects with two keys each
  CHECK_NOTHROW(parsed_as(R"([{"a": 1, "b": 2}, {"a": 1, "b": 2}])", limits));
  CHECK_THROWS_WITH(parsed_as(R"([{"a": 1, "b": 2}, {"a": 1, "b": 2, "c": 3}])", limits),
                    Contains("an object with 3 keys"));
  CHECK_THROWS_WITH(parsed_as(R"([{"a": 1, "b": 2}, {"a": 1, "b": 2}, {"a": 1}])", limits),
                    Contains("an object with 1 keys"));
}

TEST_CASE("read_json: from a file", "[report]") {
  const rigcal::test::TemporaryFolder folder;
  CHECK(read_json(folder.write("a.json", "{\"x\": 1}"), "a test").at("x") == 1);
  JsonLimits limits;
  limits.bytes = 4;
  CHECK_THROWS_WITH(read_json(folder / "a.json", "a test", limits),
                    Contains("a.json") && Contains("expected a test of at most"));
  CHECK_THROWS_WITH(read_json(folder / "none.json", "a test"), Contains("expected a test"));
}
