#include "model/plant/system.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "model/plant/load_pressure.hpp"
#include "tests/model/rig.hpp"

namespace rigcal::model {
namespace {

int row(std::string_view key) { return parameter_index(PlantKind::load_pressure, key); }

/// Linearises just before and just after the first jump of a drive.
template <int N>
void check_jump(const Rig& rig, const ParameterValues& values, const std::vector<int>& free,
                const Signal& drive) {
  constexpr int kFree = 4;
  REQUIRE(free.size() <= kFree);
  const Layout layout = layout_of(rig, values, free, LoadPressurePlant::kStates);
  REQUIRE(layout.states == N);
  System<LoadPressurePlant, N, kFree> system(layout, values, free, InputTrack(drive, 0.0, 0.0), {},
                                             {}, {});
  REQUIRE(system.drive_stops_at_valve());
  Values<N> x{};
  for (std::size_t i = 0; i < N; ++i) x[i] = 0.01 + 0.003 * static_cast<double>(i);
  x[LoadPressurePlant::load_pressure] = 1e6;
  const double t = system.drive().segment_end();
  auto followed = system.linearise(x, t);
  system.drive().next_segment();
  const auto before = followed;
  system.follow_drive(x, t, followed);
  const auto expected = system.linearise(x, t);
  CHECK((before.f != expected.f || before.f_t != expected.f_t));  // otherwise nothing jumped
  CHECK(followed.f == expected.f);
  CHECK(followed.f_t == expected.f_t);
  CHECK(followed.jacobian == expected.jacobian);
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < free.size(); ++j) {
      CAPTURE(i, j);
      CHECK(followed.f_p[i][j] == expected.f_p[i][j]);
    }
  }
}

}  // namespace

TEST_CASE("system: after a jump of the drive the rows of controller and valve are new", "[model]") {
  ParameterValues values = paper_rig();
  Rig rig;
  SECTION("recorded command, valve of first order") {
    values.set("valve_time_constant", 5e-3);
    rig.controller = ControllerKind::none;
    check_jump<4>(rig, values, {row("mass"), row("valve_gain"), row("valve_time_constant")},
                  Signal::held({0.0, 0.5}, {1.0, -2.0}));
  }
  SECTION("command between samples, valve of second order") {
    values.set("valve_frequency", 300.0);
    values.set("valve_damping_ratio", 0.7);
    rig.controller = ControllerKind::none;
    check_jump<5>(rig, values, {row("mass"), row("valve_frequency"), row("valve_damping_ratio")},
                  Signal::linear({0.0, 0.5, 0.6}, {1.0, -2.0, 4.0}));
  }
  SECTION("reference of a loop with integral and derivative, rate limit") {
    values.set("valve_frequency", 300.0);
    values.set("valve_damping_ratio", 0.7);
    values.set("valve_rate_limit", 2.0);
    values.set("ki", 3.0);
    values.set("kd", 0.2);
    values.set("derivative_filter", 100.0);
    check_jump<7>(rig, values, {row("kp"), row("ki"), row("kd"), row("valve_rate_limit")},
                  Signal::square(0.05, 1.0));
  }
}

TEST_CASE("system: a valve lag below a microsecond acts as one, and keeps its derivative",
          "[model]") {
  Rig rig;
  rig.controller = ControllerKind::none;
  Values<4> x{0.01, 0.0, 1e6, 0.5};
  const double lacks_v = 1.0 - x[3];
  const std::vector<int> free{row("valve_time_constant")};
  for (const double lag_s : {0.0, 1e-7, 1e-6, 3e-6}) {
    ParameterValues values = paper_rig();
    values.set("valve_time_constant", lag_s);
    const Layout layout = layout_of(rig, values, free, LoadPressurePlant::kStates);
    REQUIRE(layout.states == 4);
    System<LoadPressurePlant, 4, 4> system(layout, values, free,
                                           InputTrack(Signal::constant(1.0), 0.0, 0.0), {}, {}, {});
    const auto found = system.linearise(x, 0.0);
    const double acting_s = std::max(lag_s, 1e-6);
    CAPTURE(lag_s);
    CHECK_THAT(found.f[3], Catch::WithinRel(lacks_v / acting_s, 1e-12));
    CHECK_THAT(found.f_p[3][0], Catch::WithinRel(-lacks_v / (acting_s * acting_s), 1e-12));
    CHECK_THAT(system.derivative_of_values(x, 0.0)[3], Catch::WithinRel(found.f[3], 1e-12));
  }
}

}  // namespace rigcal::model
