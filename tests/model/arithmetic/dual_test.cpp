#include "model/arithmetic/dual.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// A function of (x, y), for plain numbers and for dual numbers.
struct Operation {
  const char* name;
  std::function<double(double, double)> plain;
  std::function<Dual<2>(Dual<2>, Dual<2>)> dual;
};

template <typename F>
Operation operation(const char* name, F f) {
  return {name, f, f};
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
      operation("log",
                [](auto x, auto y) {
                  using std::log;
                  return log(x / y);
                }),
      operation("x^(-1/4)", [](auto x, auto y) { return inverse_fourth_root(x + y); }),
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
// Errors of a central difference: kStep^2 / 6 times a third derivative, which is below 170 here
// (6 x / y^4 for x / y), and rounding divided by kStep, which is 1e-11.
constexpr double kDifference = 5e-9;

}  // namespace

TEST_CASE("dual: values and first derivatives agree with central differences", "[model]") {
  for (const Operation& op : operations()) {
    CAPTURE(op.name);
    const auto f = op.dual(Dual<2>::variable(kX, 0), Dual<2>::variable(kY, 1));
    CHECK_THAT(value_of(f), WithinRel(op.plain(kX, kY), 1e-15));
    const double by_x = (op.plain(kX + kStep, kY) - op.plain(kX - kStep, kY)) / (2.0 * kStep);
    const double by_y = (op.plain(kX, kY + kStep) - op.plain(kX, kY - kStep)) / (2.0 * kStep);
    CHECK_THAT(f.derivative[0], WithinAbs(by_x, kDifference));
    CHECK_THAT(f.derivative[1], WithinAbs(by_y, kDifference));
  }
}
