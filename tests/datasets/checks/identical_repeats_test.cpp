#include "datasets/checks/identical_repeats.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::datasets;
using Places = std::vector<std::size_t>;

namespace {

Repeat repeat(std::vector<double> position) {
  Repeat result;
  for (std::size_t i = 0; i < position.size(); ++i) result.time_s.push_back(static_cast<double>(i));
  result.values[Channel::position] = std::move(position);
  return result;
}

}  // namespace

TEST_CASE("first_identical: the first repeat with the same samples", "[datasets]") {
  const std::vector<Repeat> repeats{repeat({1, 2, 3}), repeat({1, 2, 4}), repeat({1, 2, 3}),
                                    repeat({1, 2}),    repeat({1, 2, 3}), repeat({1, 2, 4})};
  CHECK(first_identical(repeats, {0, 1, 2, 3, 4, 5}, Channel::position) ==
        Places{0, 1, 0, 3, 0, 1});
  CHECK(first_identical(repeats, {1, 4, 5}, Channel::position) == Places{0, 1, 0});
}

TEST_CASE("first_identical: constants and commanded signals may come twice", "[datasets]") {
  std::vector<Repeat> repeats{repeat({5, 5, 5}), repeat({5, 5, 5})};
  CHECK(first_identical(repeats, {0, 1}, Channel::position) == Places{0, 1});
  for (Repeat& each : repeats) each.values[Channel::reference] = {0, 1, 2};
  CHECK(first_identical(repeats, {0, 1}, Channel::reference) == Places{0, 1});
}
