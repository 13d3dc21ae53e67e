#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/datasets/campaign_fixture.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using rigcal::test::kExample;
using rigcal::test::line_of;
using rigcal::test::load_text;
using rigcal::test::replaced;

TEST_CASE("load_campaign: a quantity that sizes a loop has a range", "[datasets]") {
  struct Row {
    std::string key;
    std::string behind;  ///< line of the example after which the key is inserted
    std::vector<std::string> values;
  };
  const std::string in_condition = "repeats = [\"records/sine_0.1Hz_33_*.csv\"]\n";
  const std::vector<std::string> times{"1e12 s", "1e300 s", "1e-9 s", "1e-300 s"};
  for (const Row& row : {
           Row{"sample_rate", in_condition, {"1e12 Hz", "1e20 Hz", "1e300 Hz", "1e-300 Hz"}},
           Row{"duration", in_condition, times},
           Row{"decimate_to", "[recording]\n", {"1e12 Hz", "1e300 Hz", "1e-300 Hz"}},
           Row{"max_time", "[fit]\n", times},
       }) {
    std::string text = kExample;
    if (text.find(row.behind) == std::string::npos) text += row.behind;
    for (const std::string& value : row.values) {
      const std::string line = row.key + " = \"" + value + "\"\n";
      const std::string changed = replaced(text, row.behind, row.behind + line);
      CAPTURE(line);
      try {
        load_text(changed);
        FAIL_CHECK("it was read");
      } catch (const InputError& error) {
        CHECK(error.where().line == line_of(changed, line.substr(0, line.size() - 1)));
        CHECK_THAT(error.what(), Catch::Contains(row.key) && Catch::Contains(value) &&
                                     Catch::Contains("expected a quantity from"));
      }
    }
  }
}

TEST_CASE("load_campaign: a drive has a frequency that can be followed", "[datasets]") {
  for (const char* value : {"1e12 Hz", "1e20 Hz", "1e300 Hz", "100 MHz", "1e-300 Hz"}) {
    CAPTURE(value);
    CHECK_THROWS_WITH(load_text(replaced(kExample, "frequency = \"0.1 Hz\"",
                                         "frequency = \"" + std::string(value) + "\"")),
                      Catch::Contains("frequency") && Catch::Contains("from 1e-06 to 100000 Hz"));
  }
}
