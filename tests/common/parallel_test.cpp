#include "common/parallel.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

using rigcal::parallel_for;

TEST_CASE("parallel_for: every index once, for any number of threads", "[common]") {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<int> calls(100, 0);
    parallel_for(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    CHECK(calls == std::vector<int>(100, 1));
  }
  parallel_for(0, 4, [](std::size_t) { FAIL("nothing to do"); });
}

TEST_CASE("parallel_for: the error of the lowest index, after all others ran", "[common]") {
  for (const int threads : {1, 3}) {
    std::vector<int> calls(20, 0);
    std::string message;
    try {
      parallel_for(calls.size(), threads, [&](std::size_t i) {
        ++calls[i];
        if (i == 5 || i == 11) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    CHECK(message == "5");
    CHECK(calls == std::vector<int>(20, 1));
  }
}
