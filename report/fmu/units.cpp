#include "report/fmu/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace rigcal::report {
namespace {

// clang-format off
constexpr std::array kBaseUnits{
    //         unit        kg   m   s   A rad K
    BaseUnits{"1",          0,  0,  0,  0, 0, 0},
    BaseUnits{"1/s",        0,  0, -1,  0, 0, 0},
    BaseUnits{"K",          0,  0,  0,  0, 0, 1},
    BaseUnits{"1/K",        0,  0,  0,  0, 0, -1},
    BaseUnits{"kg",         1,  0,  0,  0, 0, 0},
    BaseUnits{"m",          0,  1,  0,  0, 0, 0},
    BaseUnits{"s",          0,  0,  1,  0, 0, 0},
    BaseUnits{"m2",         0,  2,  0,  0, 0, 0},
    BaseUnits{"m3",         0,  3,  0,  0, 0, 0},
    BaseUnits{"m/s",        0,  1, -1,  0, 0, 0},
    BaseUnits{"m/s2",       0,  1, -2,  0, 0, 0},
    BaseUnits{"m/s3",       0,  1, -3,  0, 0, 0},
    BaseUnits{"m3/s",       0,  3, -1,  0, 0, 0},
    BaseUnits{"m3/rad",     0,  3,  0,  0, -1, 0},
    BaseUnits{"m3/s2",      0,  3, -2,  0, 0, 0},
    BaseUnits{"N",          1,  1, -2,  0, 0, 0},
    BaseUnits{"N/s",        1,  1, -3,  0, 0, 0},
    BaseUnits{"N/m",        1,  0, -2,  0, 0, 0},
    BaseUnits{"N/m2",       1, -1, -2,  0, 0, 0},
    BaseUnits{"N s/m",      1,  0, -1,  0, 0, 0},
    BaseUnits{"Pa",         1, -1, -2,  0, 0, 0},
    BaseUnits{"Pa/s",       1, -1, -3,  0, 0, 0},
    BaseUnits{"Pa s/m3",    1, -4, -1,  0, 0, 0},
    BaseUnits{"m3/Pa",     -1,  4,  2,  0, 0, 0},
    BaseUnits{"m3/(s Pa)", -1,  4,  1,  0, 0, 0},
    BaseUnits{"kg/m3",      1, -3,  0,  0, 0, 0},
    BaseUnits{"rad/s",      0,  0, -1,  0, 1, 0},
    BaseUnits{"s/m",        0, -1,  1,  0, 0, 0},
    BaseUnits{"rad",        0,  0,  0,  0, 1, 0},
    BaseUnits{"rad/s2",     0,  0, -2,  0, 1, 0},
    BaseUnits{"kg m2",      1,  2,  0,  0, 0, 0},
    BaseUnits{"N m",        1,  2, -2,  0, 0, 0},
    BaseUnits{"N m/rad",    1,  2, -2,  0, -1, 0},
    BaseUnits{"N m/rad2",   1,  2, -2,  0, -2, 0},
    BaseUnits{"N m s/rad",  1,  2, -1,  0, -1, 0},
    BaseUnits{"m/rad",      0,  1,  0,  0, -1, 0},
    BaseUnits{"m/rad2",     0,  1,  0,  0, -2, 0},
    BaseUnits{"m/rad3",     0,  1,  0,  0, -3, 0},
    BaseUnits{"s/rad",      0,  0,  1,  0, -1, 0},
    BaseUnits{"m/Pa",      -1,  2,  2,  0, 0, 0},
    BaseUnits{"Pa/s2",      1, -1, -4,  0, 0, 0},
    BaseUnits{"V",          1,  2, -3, -1, 0, 0},
    BaseUnits{"V/s",        1,  2, -4, -1, 0, 0},
    BaseUnits{"V/s2",       1,  2, -5, -1, 0, 0},
    BaseUnits{"V/m",        1,  1, -3, -1, 0, 0},
    BaseUnits{"V/(m s)",    1,  1, -4, -1, 0, 0},
    BaseUnits{"V s/m",      1,  1, -2, -1, 0, 0},
    BaseUnits{"V/N",        0,  1, -1, -1, 0, 0},
    BaseUnits{"V/(N s)",    0,  1, -2, -1, 0, 0},
    BaseUnits{"V s/N",      0,  1,  0, -1, 0, 0},
    BaseUnits{"V/Pa",       0,  3, -1, -1, 0, 0},
    BaseUnits{"V/(Pa s)",   0,  3, -2, -1, 0, 0},
    BaseUnits{"V s/Pa",     0,  3,  0, -1, 0, 0},
    BaseUnits{"V/rad",      1,  2, -3, -1, -1, 0},
    BaseUnits{"V/(rad s)",  1,  2, -4, -1, -1, 0},
    BaseUnits{"V s/rad",    1,  2, -2, -1, -1, 0},
    BaseUnits{"V s2/rad",   1,  2, -1, -1, -1, 0},
    BaseUnits{"V/(N m)",    0,  0, -1, -1, 0, 0},
    BaseUnits{"V/(N m s)",  0,  0, -2, -1, 0, 0},
    BaseUnits{"V s/(N m)",  0,  0,  0, -1, 0, 0},
    BaseUnits{"N m/s",      1,  2, -3,  0, 0, 0},
    BaseUnits{"V s2/m",     1,  1, -1, -1, 0, 0},
    BaseUnits{"V s3/m",     1,  1,  0, -1, 0, 0},
    BaseUnits{"m/V",       -1, -1,  3,  1, 0, 0},
};
// clang-format on

}  // namespace

const BaseUnits& base_units(std::string_view unit) {
  const auto found = std::find_if(kBaseUnits.begin(), kBaseUnits.end(),
                                  [unit](const BaseUnits& row) { return row.unit == unit; });
  if (found == kBaseUnits.end())
    throw std::invalid_argument(fmt::format("base_units: no row for '{}'", unit));
  return *found;
}

}  // namespace rigcal::report
