#include "report/store/checkpoint.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/error.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Contains;
using rigcal::InputError;
using rigcal::calib::Checkpoint;
using rigcal::report::checkpoint_text;
using rigcal::report::fit_identity;
using rigcal::report::Provenance;
using rigcal::report::read_checkpoint;
using rigcal::test::replaced;
using rigcal::test::TemporaryFolder;

namespace {

Checkpoint two_starts() {
  Checkpoint checkpoint;
  for (const int number : {1, 2}) {
    rigcal::calib::StartReport start;
    start.number = number;
    start.start_values = {2000.0, 2e-5};
    start.end_values = {1000.0 + number, 3e-5};
    if (number == 2) start.final_cost = 0.1 * number;  // the first start could not be simulated
    start.iterations = 7;
    start.status = rigcal::calib::FitStatus::converged;
    checkpoint.starts.push_back(start);
  }
  checkpoint.best = 1;
  checkpoint.best_z = {0.25, 0.5};
  checkpoint.counters.evaluations = 20;
  checkpoint.counters.kept[{0, rigcal::model::SimulationStatus::not_finite}] = 3;
  return checkpoint;
}

}  // namespace

TEST_CASE("checkpoint: reads back to the same text", "[report]") {
  const TemporaryFolder folder;
  const std::string text = checkpoint_text(two_starts(), {});
  const Checkpoint again = read_checkpoint(folder.write("c.json", text), {});
  CHECK(checkpoint_text(again, {}) == text);
}

TEST_CASE("checkpoint: a fit of other records does not go on with it", "[report]") {
  const TemporaryFolder folder;
  Provenance these;
  these.inputs = {{"run.csv", "a"}};
  Provenance others;
  others.inputs = {{"run.csv", "b"}};
  const auto file = folder.write("c.json", checkpoint_text(two_starts(), these));
  CHECK_NOTHROW(read_checkpoint(file, these));
  CHECK_THROWS_WITH(read_checkpoint(file, others), Contains("its inputs differ"));
  CHECK(fit_identity(these) != fit_identity(others));
}

TEST_CASE("checkpoint: forged numbers are refused", "[report]") {
  const TemporaryFolder folder;
  const std::string text = checkpoint_text(two_starts(), {});
  struct Case {
    std::string from, to, word;
  };
  for (const Case& each : std::vector<Case>{
           {"\"number\": 2", "\"number\": 1", "numbers from 1"},
           {"\"number\": 2", "\"number\": -5", "key 'starts[1].number': found -5"},
           {"\"number\": 2", "\"number\": 2.5", "key 'starts[1].number': found 2.5"},
           {"\"iterations\": 7", "\"iterations\": 1e300",
            "key 'starts[0].iterations': found 1e+300"},
           {"\"status\": \"converged\"", "\"status\": \"odd\"", "status': found \"odd\""},
           {"\"best\": 1", "\"best\": 3", "'best': found 3, expected a whole number from 0 to 2"},
           {"\"evaluations\": 20", "\"evaluations\": null", "'evaluations': found no number"},
           {"\"iterations\": 7", "\"iterations\": 8", "was changed since it was written"},
           {"\"best_z\"", "\"best_y\"", "is not a checkpoint of rigcal fit"},
       }) {
    const auto file = folder.write("c.json", replaced(text, each.from, each.to));
    CHECK_THROWS_WITH(read_checkpoint(file, {}), Contains("c.json: ") && Contains(each.word));
  }
}
