#include "common/error.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <type_traits>

using namespace rigcal;

TEST_CASE("Location: as far as known", "[common]") {
  CHECK(Location{"a.csv"}.text() == "a.csv");
  CHECK(Location{"a.csv", 3}.text() == "a.csv:3");
  CHECK(Location{"a.csv", 3, 7}.text() == "a.csv:3:7");
  CHECK(Location{"a.csv", 0, 7}.text() == "a.csv");
}

TEST_CASE("InputError: message begins with the place", "[common]") {
  const InputError error({"a.csv", 3, 7}, "not a number");
  CHECK(std::string(error.what()) == "a.csv:3:7: not a number");
  CHECK(error.where().file == "a.csv");
  CHECK(error.where().line == 3);
  CHECK(error.where().column == 7);
}

TEST_CASE("Error: every kind has its exit code", "[common]") {
  CHECK(UsageError("").code() == ExitCode::bad_input);
  CHECK(InputError({"a"}, "").code() == ExitCode::bad_input);
  CHECK(NoResultError("").code() == ExitCode::no_result);
  CHECK(WriteError("").code() == ExitCode::internal);
  CHECK(static_cast<int>(ExitCode::done) == 0);
  CHECK(static_cast<int>(ExitCode::verdict_fail) == 1);
  CHECK(static_cast<int>(ExitCode::bad_input) == 2);
  CHECK(static_cast<int>(ExitCode::no_result) == 3);
  CHECK(static_cast<int>(ExitCode::stopped) == 4);
  CHECK(static_cast<int>(ExitCode::internal) == 5);
}

TEST_CASE("Error: all are caught by their base", "[common]") {
  CHECK_THROWS_AS(throw UsageError("u"), Error);
  CHECK_THROWS_AS(throw InputError({"a"}, "i"), Error);
  CHECK_THROWS_AS(throw NoResultError("n"), Error);
  CHECK_THROWS_AS(throw WriteError("w"), Error);
}
