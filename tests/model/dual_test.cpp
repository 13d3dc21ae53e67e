#include "model/dual.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

using First = Dual<double, 2>;
using Second = Dual<First, 2>;

/// One function of (x, y) on plain numbers, on dual numbers and on dual numbers of dual numbers.
struct Operation {
  const char* name;
  std::function<double(double, double)> plain;
  std::function<First(First, First)> first;
  std::function<Second(Second, Second)> second;
};

template <typename F>
Operation operation(const char* name, F f) {
  return {name, f, f, f};
}

std::vector<Operation> operations() {
  return {
      operation("-x", [](auto x, auto) { return -x; }),
      operation("x + y", [](auto x, auto y) { return x + y; }),
      operation("x + 2", [](auto x, auto) { return x + 2.0; }),
      operation("2 + x", [](auto x, auto) { return 2 + x; }),
      operation("x - y", [](auto x, auto y) { return x - y; }),
      operation("x - 2", [](auto x, auto) { return x - 2.0; }),
      operation("2 - x", [](auto x, auto) { return 2.0 - x; }),
      operation("x * y", [](auto x, auto y) { return x * y; }),
      operation("3 * x", [](auto x, auto) { return 3.0 * x; }),
      operation("x * 3", [](auto x, auto) { return x * 3; }),
      operation("x / y", [](auto x, auto y) { return x / y; }),
      operation("x / 4", [](auto x, auto) { return x / 4.0; }),
      operation("4 / x", [](auto x, auto) { return 4.0 / x; }),
      operation("x += y", [](auto x, auto y) { return x += y; }),
      operation("x -= y", [](auto x, auto y) { return x -= y; }),
      operation("x *= y", [](auto x, auto y) { return x *= y; }),
      operation("sqrt",
                [](auto x, auto y) {
                  using std::sqrt;
                  return sqrt(x * y);
                }),
      operation("exp",
                [](auto x, auto y) {
                  using std::exp;
                  return exp(-x * y);
                }),
      operation("tanh",
                [](auto x, auto y) {
                  using std::tanh;
                  return tanh(x - y);
                }),
      operation("all",
                [](auto x, auto y) {
                  using std::exp;
                  using std::sqrt;
                  using std::tanh;
                  return sqrt(x + 2.0 * y) * exp(-(x * x)) / (1.0 + tanh(y) * x);
                }),
  };
}

constexpr double kX = 0.7;
constexpr double kY = 0.4;
constexpr double kStep = 1e-5;
// A central difference is off by kStep^2 / 6 of a third derivative of what it differs (below 1700
// here: x / y^4 of x / y) and by rounding over kStep, 1e-11.
constexpr double kDifference = 5e-8;

First lift(double value, int direction) { return First::variable(value, direction); }

}  // namespace

TEST_CASE("dual: values and first derivatives agree with central differences", "[model]") {
  for (const Operation& op : operations()) {
    CAPTURE(op.name);
    const First f = op.first(lift(kX, 0), lift(kY, 1));
    CHECK_THAT(f.value, WithinRel(op.plain(kX, kY), 1e-15));
    const double by_x = (op.plain(kX + kStep, kY) - op.plain(kX - kStep, kY)) / (2.0 * kStep);
    const double by_y = (op.plain(kX, kY + kStep) - op.plain(kX, kY - kStep)) / (2.0 * kStep);
    CHECK_THAT(f.derivative[0], WithinAbs(by_x, kDifference));
    CHECK_THAT(f.derivative[1], WithinAbs(by_y, kDifference));
  }
}

TEST_CASE("dual: nested derivatives agree with differences of first ones", "[model]") {
  for (const Operation& op : operations()) {
    CAPTURE(op.name);
    const Second f = op.second(Second::variable(lift(kX, 0), 0), Second::variable(lift(kY, 1), 1));
    const First first = op.first(lift(kX, 0), lift(kY, 1));
    const auto along = [&](double dx, double dy) {
      return op.first(lift(kX + dx, 0), lift(kY + dy, 1));
    };
    const First differences[] = {along(kStep, 0.0) - along(-kStep, 0.0),
                                 along(0.0, kStep) - along(0.0, -kStep)};
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK_THAT(f.derivative[i].value, WithinRel(first.derivative[i], 1e-14));
      for (std::size_t j = 0; j < 2; ++j) {
        const double expected = differences[j].derivative[i] / (2.0 * kStep);
        CHECK_THAT(f.derivative[i].derivative[j], WithinAbs(expected, kDifference));
      }
    }
  }
}

TEST_CASE("dual: an operand of the inner type has no outer derivative", "[model]") {
  const First p = lift(kX, 0);
  const Second x = Second::variable(lift(kY, 1), 1);
  for (const Second& product : {x * p, p * x}) {
    CHECK(product.value.value == kX * kY);
    CHECK(product.derivative[0].value == 0.0);
    CHECK(product.derivative[1].value == kX);           // d(p x)/dx
    CHECK(product.derivative[1].derivative[0] == 1.0);  // d2(p x)/dx dp
  }
  CHECK((x + p).derivative[1].value == 1.0);
  CHECK((p - x).derivative[1].value == -1.0);
  CHECK_THAT((p / x).derivative[1].value, WithinRel(-kX / (kY * kY), 1e-15));
  CHECK(value_of(x) == kY);
}
