#include "report/json/described.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/error.hpp"

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;

namespace {

enum class Colour { red, green };

std::string_view to_string(Colour colour) { return colour == Colour::red ? "red" : "green"; }

struct Part {
  std::string name;
  Colour colour = Colour::red;
  RIGCAL_DESCRIBE(name, colour)
};

struct Whole {
  int count = 0;
  double value = 0.0;
  bool class_ = false;  ///< its key is "class", a keyword in C++
  std::optional<double> maybe;
  std::optional<Range> range;
  Omittable<double> amplitude_m;
  std::vector<Part> parts;
  Keyed<double> limits;
  std::array<double, 2> pair{};
  RIGCAL_DESCRIBE(count, value, class_, maybe, range, amplitude_m, parts, limits, pair)
};

const Whole kWhole{3,
                   0.1,
                   true,
                   std::nullopt,
                   Range{-1.0, 2.0},
                   {},
                   {{"valve", Colour::green}},
                   {{"slight", 10.0}, {"medium", 20.0}},
                   {1.0, 2.0}};

Whole read_text(const std::string& text) {
  Whole whole;
  const Json json = Json::parse(text);
  read_into(JsonNode(json, "whole.json", "", "whole.json"), whole);
  return whole;
}

}  // namespace

namespace rigcal::report {
template <>
std::vector<Colour> every() {
  return {Colour::red, Colour::green};
}
}  // namespace rigcal::report

namespace {

/// A struct with an inlined member.
struct Holder {
  int number = 0;
  Inlined<Part> part;
  bool last = false;
  RIGCAL_DESCRIBE(number, part, last)
};

/// One of the rows that a file has in columns.
struct ScoreRow {
  std::string channel;
  double score = 0.0;
  Later<std::optional<double>> error;
  Omittable<double> floor;
  RIGCAL_DESCRIBE(score, error, floor)
};

struct ScoreColumns {
  int number = 0;
  Columns<ScoreRow> rows;
  bool last = false;
  RIGCAL_DESCRIBE(number, rows, last)
};

ScoreColumns read_columns_text(const std::string& text) {
  ScoreColumns rows;
  const Json json = Json::parse(text);
  read_into(JsonNode(json, "rows.json", "", "rows.json"), rows);
  return rows;
}

}  // namespace

TEST_CASE("described: rows are an object per member, by channel", "[report]") {
  ScoreColumns rows;
  CHECK(json_of(rows).dump() == R"({"number":0,"score":{},"error":{},"last":false})");
  rows.rows = {{"b", 1.0, std::optional(0.5), {}}, {"a", 2.0, {}, 3.0}};
  const std::string text =
      R"({"number":0,"score":{"b":1.0,"a":2.0},"error":{"b":0.5,"a":null},"floor":{"a":3.0},)"
      R"("last":false})";
  CHECK(json_of(rows).dump() == text);
  CHECK(json_of(read_columns_text(text)).dump() == text);
  CHECK(schema_of<ScoreColumns>()["required"].dump() == R"(["number","score","last"])");
  CHECK(schema_of<ScoreColumns>()["properties"]["floor"].dump() ==
        R"({"type":"object","additionalProperties":{"type":["number","null"]}})");
}

TEST_CASE("described: of rows, earlier files lack what came later, and nothing else", "[report]") {
  const ScoreColumns earlier =
      read_columns_text(R"({"number":1,"score":{"a":2.0,"b":1.0},"last":true})");
  REQUIRE(earlier.rows.size() == 2);
  CHECK(earlier.rows[0].channel == "a");
  CHECK(earlier.rows[1].score == 1.0);
  CHECK_FALSE(earlier.rows[0].error.has_value());
  CHECK_FALSE(earlier.rows[0].floor.has_value());
  // The first column names the rows.
  CHECK(read_columns_text(R"({"number":1,"score":{},"error":{"a":0.5},"last":true})").rows.empty());
  CHECK_THROWS_WITH(read_columns_text(R"({"number":1,"error":{},"last":true})"),
                    Contains("key 'score' is missing"));
  CHECK_THROWS_WITH(read_columns_text(R"({"number":1,"score":{"a":"ten"},"last":true})"),
                    Contains("key 'score.a'") && Contains("a number"));
}

TEST_CASE("described: keys of an inlined struct are among the others", "[report]") {
  Holder holder;
  holder.part.name = "a";
  holder.part.colour = Colour::green;
  const Json json = json_of(holder);
  CHECK(json.dump() == R"({"number":0,"name":"a","colour":"green","last":false})");
  Holder read;
  read_into(JsonNode(json, "a.json", "", "a.json"), read);
  CHECK(read.part.colour == Colour::green);
  CHECK(schema_of<Holder>()["required"].dump() == R"(["number","name","colour","last"])");
}

TEST_CASE("described: as it is read back, without its text", "[report]") {
  const double infinity = std::numeric_limits<double>::infinity();
  Whole whole = kWhole;
  whole.value = infinity;
  whole.maybe = std::nan("");
  whole.range = Range{-infinity, 2.0};
  whole.amplitude_m = infinity;
  whole.parts[0].name = "valve \xfc \xc3\xbc";
  whole.limits[0] = {"\xff", -infinity};
  whole.pair = {0.1 + 0.2, infinity};
  const Whole read = read_text(json_of(whole).dump(-1, ' ', false, Json::error_handler_t::replace));
  as_read_back(whole);
  CHECK(std::isnan(whole.value));
  CHECK_FALSE(whole.maybe);
  CHECK(std::isnan(whole.range->low));
  CHECK_FALSE(whole.amplitude_m);
  CHECK(whole.parts[0].name == "valve \xef\xbf\xbd \xc3\xbc");
  CHECK(whole.parts[0].name == read.parts[0].name);
  CHECK(whole.limits[0].first == read.limits[0].first);
  CHECK(whole.pair[0] == read.pair[0]);
  CHECK(std::isnan(whole.pair[1]));
  CHECK(json_of(whole)["parts"] == json_of(read)["parts"]);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(2, 2);
  matrix(0, 1) = infinity;
  as_read_back(matrix);
  CHECK(std::isnan(matrix(0, 1)));
  CHECK(matrix(1, 1) == 1.0);
}

TEST_CASE("described: members are keys in their order", "[report]") {
  CHECK(json_of(kWhole).dump() ==
        R"({"count":3,"value":0.1,"class":true,"maybe":null,"range":[-1.0,2.0],)"
        R"("parts":[{"name":"valve","colour":"green"}],"limits":{"slight":10.0,"medium":20.0},)"
        R"("pair":[1.0,2.0]})");
  Whole closed_loop = kWhole;
  closed_loop.amplitude_m = 0.05;
  CHECK(json_of(closed_loop).at("amplitude_m") == 0.05);
  Whole unknown = kWhole;
  unknown.value = std::nan("");
  unknown.maybe = HUGE_VAL;
  CHECK(json_of(unknown).at("value").is_null());
  CHECK(json_of(unknown).at("maybe").is_null());
}

TEST_CASE("described: what was written is read back", "[report]") {
  for (const bool closed_loop : {false, true}) {
    Whole whole = kWhole;
    if (closed_loop) whole.amplitude_m = 0.05;
    CHECK(json_of(read_text(json_of(whole).dump())) == json_of(whole));
  }
  CHECK(std::isnan(read_text(json_of(kWhole).dump().replace(19, 3, "null")).value));
}

TEST_CASE("described: what is wrong is named with its key", "[report]") {
  const std::string good = json_of(kWhole).dump();
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    try {
      read_text(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no complaint");
  };
  CHECK_THAT(complaint("\"count\"", "\"counts\""), Contains("key 'count' is missing"));
  CHECK_THAT(complaint(":3", ":3.5"), Contains("key 'count'") && Contains("a whole number"));
  CHECK_THAT(complaint(":3", ":3000000000"), Contains("a whole number"));
  CHECK_THAT(complaint("green", "blue"),
             Contains("key 'parts[0].colour'") && Contains("one of red, green"));
  CHECK_THAT(complaint("[1.0,2.0]}", "[1.0]}"), Contains("key 'pair'") && Contains("a list of 2"));
  CHECK_THAT(complaint("10.0", "\"ten\""), Contains("key 'limits.slight'") && Contains("a number"));
}

TEST_CASE("described: the schema has what must be there and of which kind", "[report]") {
  const Json schema = schema_of<Whole>();
  CHECK(schema.at("required").dump() ==
        R"(["count","value","class","maybe","range","parts","limits","pair"])");
  const Json& properties = schema.at("properties");
  CHECK(properties.at("amplitude_m").dump() == R"({"type":["number","null"]})");
  CHECK(properties.at("count").dump() == R"({"type":"integer","minimum":0})");
  CHECK(properties.at("range").at("type").dump() == R"(["array","null"])");
  CHECK(properties.at("parts").at("items").at("properties").at("colour").dump() ==
        R"({"enum":["red","green"]})");
}
