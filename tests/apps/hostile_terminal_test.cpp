#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tests/apps/cli_fixture.hpp"

namespace rigcal::test {
namespace {

using Catch::Contains;

/// Returns true if a terminal would only display the text, not act on it.
bool is_harmless(const std::string& text) {
  const auto acts = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7f;
  };
  return std::none_of(text.begin(), text.end(), acts) && text.find("\u009b") == std::string::npos &&
         text.find("\u202e") == std::string::npos;
}

}  // namespace

TEST_CASE("terminal: names of files, arguments and campaigns are shown, not obeyed", "[apps]") {
  const CommandFolder folder;
  write_campaign(folder);
  const std::string evil = "evil\x1b]0;pwned\a\u009b2J\u202e";
  const auto check = [&](const CommandFolder::Arguments& arguments, const std::string& sign) {
    const Outcome outcome = folder.run(arguments);
    CAPTURE(arguments.front(), sign, outcome.out, outcome.err);
    CHECK(is_harmless(outcome.err));
    CHECK(is_harmless(outcome.out));
    CHECK_THAT(outcome.out + outcome.err, Contains(sign));
  };
  folder.write(evil + ".csv", "no,channels\n0,1\n");
  check({"init", evil + ".csv"}, "evil\\u001B]0;pwned\\u0007");
  check({"check", evil + ".toml"}, "\\u009B2J\\u202E");
  check({"check", "campaign.toml", "--set", "mass=\"" + evil + "\""}, "\\u001B]0;");
  check({"check", "campaign.toml", "--set", evil + "=1"}, "\\u001B]0;");
  check({evil}, "\\u001B]0;");
  check({"check", "campaign.toml", "--" + evil}, "\\u001B]0;");
  folder.write("named.toml",
               edited(kCampaign, {{"small rig", R"(evil\u001B]0;pwned\u009B2J\u202E)"},
                                  {"leak_level = \"none\"\nuse = \"fit\"",
                                   "leak_level = \"none\\u009B2J\"\nuse = \"fit\""}}));
  for (const char* verb : {"check", "average", "fit"}) {
    check({verb, "named.toml", "--out", "out"}, "sine");
    check({verb, "named.toml", "--out", "out", "--json"}, "{");
  }
  check({"fit", "named.toml", "--out", "out"}, "none\\u009B2J");
  folder.write("column.toml", edited(kCampaign, {{"x_mm", R"(x\u001B]0;pwned\r)"}}));
  check({"check", "column.toml"}, "\\u001B]0;");
}

}  // namespace rigcal::test
