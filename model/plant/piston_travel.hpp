#pragma once

#include <array>
#include <cmath>

#include "model/plant/linkage_parameters.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// Law of the piston's travel over the angle of a joint.
enum class TravelLaw { polynomial, triangle, table };

/// Reads the law from the parameters: a triangle has lengths, and a table ends above its beginning.
template <typename C>
TravelLaw travel_law(const LinkageParameters<C>& p) {
  if (value_of(p.triangle_base_m) > 0.0) return TravelLaw::triangle;
  if (value_of(p.travel_table_to_rad) > value_of(p.travel_table_from_rad)) return TravelLaw::table;
  return TravelLaw::polynomial;
}

/// Travel of the piston at an angle, and its derivatives with respect to the angle.
template <typename X>
struct PistonTravel {
  X travel_m;
  X lever_m_per_rad;
  X slope_m_per_rad2;  ///< change of the lever per angle
};

/// Side of a triangle opposite to an angle, by the law of cosines [m].
template <typename X, typename C>
X opposite_side(const X& angle_rad, const C& base_m, const C& arm_m) {
  using std::cos;
  using std::sqrt;
  return sqrt(X(base_m * base_m + arm_m * arm_m - cos(angle_rad) * (2.0 * base_m * arm_m)));
}

/// Travel of a cylinder between a pivot on the base and one on the arm. It is the length of the
/// cylinder, s = sqrt(a^2 + b^2 - 2 a b cos psi), minus that at the reference angle, with the sign
/// that makes it grow with the angle; s' = a b sin(psi) / s, s'' = (a b cos(psi) - s'^2) / s.
///
/// Not inlined, to keep the code of a polynomial short.
///
/// @param from_rad  angle from the reference angle
template <typename X, typename C>
[[gnu::noinline]] PistonTravel<X> triangle_travel(const X& from_rad,
                                                  const LinkageParameters<C>& p) {
  using std::cos;
  using std::sin;
  const X psi = from_rad + p.triangle_angle_rad;
  const C product = p.triangle_base_m * p.triangle_arm_m;
  const X side = opposite_side(psi, p.triangle_base_m, p.triangle_arm_m);
  const C at_reference = opposite_side(p.triangle_angle_rad, p.triangle_base_m, p.triangle_arm_m);
  const X lever = sin(psi) * product / side;
  const X slope = (cos(psi) * product - lever * lever) / side;
  const double sign = value_of(p.triangle_angle_rad) < 0.0 ? -1.0 : 1.0;
  return {(side - at_reference) * sign, lever * sign, slope * sign};
}

/// Travel by the table of six values. The parabolas around its corners meet, so the lever is a line
/// from the middle of each piece to that of the next, where it is the slope of the piece.
///
/// Not inlined, to keep the code of a polynomial short.
template <typename X, typename C>
[[gnu::noinline]] PistonTravel<X> table_travel(const X& angle_rad, const LinkageParameters<C>& p) {
  constexpr double kRounded = 0.5;
  const std::array<C, 6> travel_m{p.travel_0_m,  p.travel_20_m, p.travel_40_m,
                                  p.travel_60_m, p.travel_80_m, p.travel_100_m};
  const C per_rad = kTablePieces / (p.travel_table_to_rad - p.travel_table_from_rad);
  const X place = (angle_rad - p.travel_table_from_rad) * per_rad;
  const std::array<X, 2> slopes = rounded_table_slopes(place, travel_m, kRounded);
  return {rounded_table(place, travel_m, kRounded), slopes[0] * per_rad,
          slopes[1] * (per_rad * per_rad)};
}

/// Travel of the piston of a linkage at an angle.
///
/// @param values  of the plant linkage
PistonTravel<double> piston_travel(const ParameterValues& values, double angle_rad);

}  // namespace rigcal::model
