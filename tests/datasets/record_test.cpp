#include "datasets/record.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <string>

using namespace rigcal::datasets;

TEST_CASE("channels: the table is in the order of the enumeration", "[datasets]") {
  REQUIRE(channel_table().size() == 21);
  for (const ChannelInfo& row : channel_table()) {
    CAPTURE(row.key);
    CHECK(info(row.channel).key == row.key);
    CHECK(channel_from_key(row.key) == row.channel);
  }
  CHECK(info(Channel::temperature).key == "temperature");
}

TEST_CASE("channels: a name is the key with its SI unit", "[datasets]") {
  std::set<std::string_view> names;
  for (const ChannelInfo& row : channel_table()) {
    CAPTURE(row.name);
    std::string unit(row.unit);
    for (char& letter : unit) letter = static_cast<char>(std::tolower(letter));
    if (const std::size_t over = unit.find('/'); over != std::string::npos)
      unit.replace(over, 1, "_per_");
    std::replace(unit.begin(), unit.end(), ' ', '_');
    CHECK(row.name == std::string(row.key) + "_" + unit);
    names.insert(row.name);
  }
  CHECK(names.size() == channel_table().size());
}

TEST_CASE("channels: inputs and temperature are no outputs", "[datasets]") {
  CHECK(info(Channel::position).is_output);
  CHECK(info(Channel::pressure_b).is_output);
  CHECK_FALSE(info(Channel::reference).is_output);
  CHECK_FALSE(info(Channel::command).is_output);
  CHECK_FALSE(info(Channel::supply_pressure).is_output);
  CHECK_FALSE(info(Channel::temperature).is_output);
}

TEST_CASE("channels: an unknown key is no channel", "[datasets]") {
  CHECK_FALSE(channel_from_key("Position").has_value());
  CHECK_FALSE(channel_from_key("").has_value());
}
