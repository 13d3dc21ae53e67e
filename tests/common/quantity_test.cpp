#include "common/quantity.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <clocale>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

using Catch::Contains;
using Catch::WithinRel;
using rigcal::parse_quantity;
using rigcal::QuantityError;
using rigcal::unit_conversion;

namespace {

constexpr double kPi = 3.14159265358979323846;
// A conversion takes a few multiplications, each of which may be off by half a unit in the last
// place.
constexpr double kRounding = 1e-14;

std::string error_of(const std::string& text, const std::string& unit) {
  try {
    parse_quantity(text, unit);
  } catch (const QuantityError& error) {
    return error.what();
  }
  return "no error";
}

struct Example {
  std::string text;
  std::string unit;
  double value;
};

}  // namespace

TEST_CASE("parse_quantity: units of the campaign file become SI", "[common]") {
  const auto example = GENERATE(
      Example{"6.2 MPa", "Pa", 6.2e6}, Example{"6.2MPa", "Pa", 6.2e6},
      Example{"62 bar", "Pa", 6.2e6}, Example{"6200 kPa", "Pa", 6.2e6},
      Example{"1 psi", "Pa", 6894.757293168361}, Example{"0.689 GPa", "Pa", 6.89e8},
      Example{"1000 N s/m", "N s/m", 1000.0}, Example{"1e5 N*s/m", "N s/m", 1e5},
      Example{"1 kN s/m", "N s/m", 1000.0}, Example{"1 kg/s", "N s/m", 1.0},
      Example{"2 V s/m", "V s/m", 2.0}, Example{"78.74 V/m", "V/m", 78.74},
      Example{"3 V/mm", "V/m", 3000.0}, Example{"5 V/(m s)", "V/(m s)", 5.0},
      Example{"2 m3/(s Pa)", "m3/(s Pa)", 2.0}, Example{"3 mm2/mm", "m", 3e-3},
      Example{"468 cm3", "m3", 468e-6}, Example{"633 mm2", "m2", 633e-6},
      Example{"633 mm^2", "m2", 633e-6}, Example{"633 mm**2", "m2", 633e-6},
      Example{"633 mm²", "m2", 633e-6}, Example{"10 L/min", "m3/s", 1e-2 / 60.0},
      Example{"10 l/min", "m3/s", 1e-2 / 60.0}, Example{"5 s-1", "1/s", 5.0},
      Example{"5 1/s", "1/s", 5.0}, Example{"5 1 / s", "1/s", 5.0}, Example{"50 um", "m", 50e-6},
      Example{"50 µm", "m", 50e-6}, Example{"870 kg/m3", "kg/m3", 870.0},
      Example{"90 deg", "rad", kPi / 2.0}, Example{"  -5\tmm  ", "m", -5e-3},
      Example{"+5 mm", "m", 5e-3}, Example{".5 mm", "m", 5e-4}, Example{"5. mm", "m", 5e-3},
      Example{"1E-3 m", "mm", 1.0}, Example{"0 N s/m", "N s/m", 0.0});
  CAPTURE(example.text);
  CHECK_THAT(parse_quantity(example.text, example.unit), WithinRel(example.value, kRounding));
}

TEST_CASE("parse_quantity: dimensionless values", "[common]") {
  CHECK(parse_quantity("0.3", "1") == 0.3);
  CHECK(parse_quantity("0.3", "") == 0.3);
  CHECK(parse_quantity("0.3 1", "1") == 0.3);
  CHECK_THAT(parse_quantity("33.33 %", "1"), WithinRel(0.3333, kRounding));
}

TEST_CASE("parse_quantity: temperatures have an offset", "[common]") {
  CHECK_THAT(parse_quantity("38 degC", "K"), WithinRel(311.15, kRounding));
  CHECK_THAT(parse_quantity("-40 degF", "degC"), WithinRel(-40.0, 1e-12));  // subtracts ~460
  CHECK_THAT(parse_quantity("311.15 K", "degC"), WithinRel(38.0, 1e-12));
  CHECK_THAT(parse_quantity("212 degF", "K"), WithinRel(373.15, kRounding));
  // In a compound unit, a degree is a temperature difference.
  CHECK_THAT(parse_quantity("2 bar/degC", "Pa/K"), WithinRel(2e5, kRounding));
}

TEST_CASE("unit_conversion: affine map", "[common]") {
  const auto temperature = unit_conversion("degC", "K");
  CHECK(temperature.scale == 1.0);
  CHECK_THAT(temperature.offset, WithinRel(273.15, kRounding));
  CHECK_THAT(temperature(0.0), WithinRel(273.15, kRounding));
  const auto pressure = unit_conversion("bar", "Pa");
  CHECK(pressure.offset == 0.0);
  CHECK_THAT(pressure(3.0), WithinRel(3e5, kRounding));
  CHECK(unit_conversion("1", "")(7.0) == 7.0);
}

TEST_CASE("unit_conversion: there and back is the identity", "[common]") {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"degF", "K"}, {"Hz", "rad/s"}, {"gpm", "m3/s"}, {"psi", "Pa"}, {"rpm", "Hz"}}) {
    CAPTURE(from, to);
    // The offset of temperature scales costs two digits.
    CHECK_THAT(unit_conversion(to, from)(unit_conversion(from, to)(12.5)), WithinRel(12.5, 1e-12));
  }
}

TEST_CASE("parse_quantity: Hz and rad/s convert by 2 pi", "[common]") {
  CHECK_THAT(parse_quantity("0.1 Hz", "rad/s"), WithinRel(0.2 * kPi, kRounding));
  CHECK_THAT(parse_quantity("1 rad/s", "Hz"), WithinRel(0.5 / kPi, kRounding));
  CHECK(parse_quantity("0.1 Hz", "Hz") == 0.1);
  CHECK(parse_quantity("400 rad/s", "rad/s") == 400.0);
  CHECK(parse_quantity("1 kHz", "Hz") == 1000.0);
  CHECK_THAT(parse_quantity("2 kHz", "rad/s"), WithinRel(4000.0 * kPi, kRounding));
  CHECK_THAT(parse_quantity("3 hertz", "rad/s"), WithinRel(6.0 * kPi, kRounding));
  CHECK_THAT(parse_quantity("60 rpm", "Hz"), WithinRel(1.0, kRounding));
  CHECK_THAT(parse_quantity("60 rev/min", "Hz"), WithinRel(1.0, kRounding));
  CHECK_THAT(parse_quantity("360 deg/s", "Hz"), WithinRel(1.0, kRounding));
}

TEST_CASE("parse_quantity: 1/s is neither Hz nor rad/s", "[common]") {
  for (const std::string unit : {"Hz", "rad/s"}) {
    CHECK_THAT(error_of("5 1/s", unit), Contains("1/s") && Contains("2 pi") &&
                                            Contains("expected a frequency such as \"0.1 Hz\""));
    CHECK_THAT(error_of("5 " + unit, "1/s"), Contains("2 pi") && Contains("expected a rate"));
  }
  CHECK_THAT(error_of("5 V Hz/m", "V/(m s)"), Contains("angle") && Contains("5 V/(m s)"));
  CHECK_THAT(error_of("5 rad", "1"), Contains("angle"));
}

TEST_CASE("parse_quantity: a torque, as it is usually written", "[common]") {
  CHECK(parse_quantity("5 Nm", "N m") == 5.0);
  CHECK(parse_quantity("2 kNm", "N m") == 2000.0);
  CHECK(parse_quantity("2 kN m", "N m") == 2000.0);
  CHECK_THAT(error_of("5 N", "N m"), Contains("'N' is the unit of a force") &&
                                         Contains("expected a torque such as \"300 N m\""));
}

TEST_CASE("parse_quantity: a period is no frequency", "[common]") {
  // UDUNITS by itself would convert using the reciprocal.
  CHECK_THAT(error_of("10 s", "Hz"), Contains("'s' is the unit of a time"));
  CHECK_THAT(error_of("10 s", "1/s"), Contains("'s' is the unit of a time"));
}

TEST_CASE("parse_quantity: lpm and gpm, alone and in compound units", "[common]") {
  const double litre_per_minute = 1e-3 / 60.0;
  const double gallon_per_minute = 3.785411784e-3 / 60.0;  // 231 cubic inches
  CHECK_THAT(parse_quantity("10 lpm", "m3/s"), WithinRel(10.0 * litre_per_minute, kRounding));
  // The database defines the gallon with 7 digits.
  CHECK_THAT(parse_quantity("10 gpm", "m3/s"), WithinRel(10.0 * gallon_per_minute, 1e-6));
  CHECK_THAT(parse_quantity("1 lpm/bar", "m3/(s Pa)"),
             WithinRel(litre_per_minute / 1e5, kRounding));
  CHECK_THAT(parse_quantity("1 lpm/(V bar)", "m3/(s V Pa)"),
             WithinRel(litre_per_minute / 1e5, kRounding));
  CHECK_THAT(parse_quantity("1 gpm/psi", "m3/(s Pa)"),
             WithinRel(gallon_per_minute / 6894.757293168361, 1e-6));
  CHECK_THAT(parse_quantity("6 V/lpm", "V/(L/min)"), WithinRel(6.0, kRounding));
}

TEST_CASE("parse_quantity: errors say what was wrong and what was expected", "[common]") {
  struct Case {
    std::string text;
    std::string unit;
    std::string reason;
  };
  const auto wrong = GENERATE(
      Case{"6,2 MPa", "Pa", "decimal point"}, Case{"1,000 N", "N", "decimal point"},
      Case{"6.2", "Pa", "unit is missing"}, Case{"0", "Pa", "unit is missing"},
      Case{"MPa", "Pa", "number before the unit is missing"}, Case{"", "Pa", "text is empty"},
      Case{"  ", "Pa", "text is empty"}, Case{"inf Pa", "Pa", "not finite"},
      Case{"-inf Pa", "Pa", "not finite"}, Case{"nan Pa", "Pa", "not finite"},
      Case{"infinity", "1", "not finite"}, Case{"1e999 Pa", "Pa", "too large"},
      Case{"1e308 MPa", "Pa", "too large"}, Case{"6.2 MPa 5", "Pa", "has a number"},
      Case{"6.2 5 MPa", "Pa", "has a number"}, Case{"1 000 N", "N", "has a number"},
      Case{"5 mm2.5", "m2", "has a number"}, Case{"6.2 10*Pa", "Pa", "has a number"},
      Case{"6.2 Pa*10", "Pa", "has a number"}, Case{"6.2 Pa -1", "Pa", "has a number"},
      Case{"6.2 MPa foo", "Pa", "unknown unit 'MPa foo'"}, Case{"0x10 Pa", "Pa", "unknown unit"},
      Case{"6.2 Mpa", "Pa", "did you mean 'MPa'"}, Case{"5 hz", "Hz", "did you mean 'Hz'"},
      Case{"6.2 mm", "Pa", "'mm' is the unit of a length"},
      Case{"5 %", "V", "'%' is the unit of a pure number"}, Case{"5", "V", "a unit is missing"},
      Case{"5 V", "V/m", "'V' is the unit of a voltage"}, Case{"0.3 m", "1", "unit of a length"},
      Case{"3 kg V", "Pa", "another dimension"}, Case{"+-5 mm", "m", "number before the unit"},
      Case{"- 5 mm", "m", "number before the unit"}, Case{"5 m/", "m", "unknown unit"},
      Case{"5 m(", "m", "unknown unit"}, Case{"5 m@3", "m", "unknown unit"},
      Case{"5 lg(re mW)", "1", "unknown unit"}, Case{"5 s since now", "s", "unknown unit"});
  const std::string message = error_of(wrong.text, wrong.unit);
  CHECK_THAT(message, Contains("'" + wrong.text + "'") && Contains(wrong.reason) &&
                          Contains("expected a") && Contains(" such as \""));
}

TEST_CASE("parse_quantity: the example in an error is accepted itself", "[common]") {
  const std::string unit =
      GENERATE("1", "m", "m2", "m3", "m3/s", "s", "Hz", "rad/s", "1/s", "rad", "kg", "kg/m3", "N",
               "Pa", "m/s", "m/s2", "N/m", "N s/m", "V", "A", "K", "V/m", "V s/m", "V/(m s)", "m/V",
               "m3/(s Pa)", "kg A/V2");
  const std::string message = error_of("nonsense", unit);
  CAPTURE(message);
  const auto begin = message.find('"');
  REQUIRE(begin != std::string::npos);
  const std::string example = message.substr(begin + 1, message.rfind('"') - begin - 1);
  CHECK_NOTHROW(parse_quantity(example, unit));
}

TEST_CASE("unit_conversion: errors name both units", "[common]") {
  CHECK_THROWS_WITH(unit_conversion("mm", "Pa"), Contains("'mm'") && Contains("'Pa'") &&
                                                     Contains("a pressure such as \"6.2 MPa\""));
  CHECK_THROWS_WITH(unit_conversion("", "Pa"), Contains("unit is missing"));
  CHECK_THROWS_WITH(unit_conversion("furlongs_", "m"), Contains("unknown unit 'furlongs_'"));
  CHECK_THROWS_WITH(unit_conversion("m", "furlongs_"), Contains("unknown unit 'furlongs_'"));
  CHECK_THROWS_AS(unit_conversion("2 mm", "m"), QuantityError);
}

TEST_CASE("parse_quantity: writes nothing to stderr", "[common]") {
  std::FILE* captured = std::tmpfile();
  REQUIRE(captured != nullptr);
  std::fflush(stderr);
  const int saved = ::dup(2);
  ::dup2(::fileno(captured), 2);
  const std::string message = error_of("5 no_such_unit((", "Pa");
  std::fflush(stderr);
  ::dup2(saved, 2);
  ::close(saved);
  std::fseek(captured, 0, SEEK_END);
  const long written = std::ftell(captured);
  std::fclose(captured);
  CHECK(written == 0);
  CHECK_THAT(message, Contains("unknown unit"));
}

TEST_CASE("parse_quantity: threads do not disturb each other", "[common]") {
  constexpr int kThreads = 4;
  std::vector<int> right(kThreads, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t)
    threads.emplace_back([t, &right] {
      for (int i = 0; i < 200; ++i) {
        const bool value = parse_quantity("0.5 kPa", "Pa") == 500.0;
        const bool error = error_of("5 no_such_unit", "Pa").find("unknown") != std::string::npos;
        right[static_cast<std::size_t>(t)] += value && error ? 1 : 0;
      }
    });
  for (auto& thread : threads) thread.join();
  CHECK(right == std::vector<int>(kThreads, 200));
}

TEST_CASE("parse_quantity: a locale with decimal comma changes nothing", "[common]") {
  // If no such locale is installed, the default one is tested again.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "pt_PT.UTF-8"})
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  const double value = parse_quantity("1.5 inch", "m");
  const std::string message = error_of("1,5 inch", "m");
  std::setlocale(LC_ALL, before.c_str());
  CHECK_THAT(value, WithinRel(0.0381, kRounding));
  CHECK_THAT(message, Contains("decimal point"));
}

TEST_CASE("parse_quantity: control characters are refused, and shown", "[common]") {
  using namespace std::string_view_literals;
  CHECK_THROWS_WITH(parse_quantity("60 kg\0x"sv, "kg"),
                    Contains("'60 kg?x'") && Contains("control character"));
  CHECK_THROWS_AS(parse_quantity("60\n kg", "kg"), QuantityError);
  CHECK_THROWS_AS(unit_conversion("mm\0"sv, "m"), QuantityError);
  CHECK(parse_quantity("60\tkg", "kg") == 60.0);
}
