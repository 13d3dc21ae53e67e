#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "model/plant/plant_input.hpp"

namespace rigcal::model {

template <typename T>
struct FirstOrderParameters : CommonParameters<T> {
  T velocity_gain_m_per_s_v{};
  T velocity_lag_s{};
};

template <typename T>
constexpr auto first_order_fields() {
  using P = FirstOrderParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  const auto own = std::array{
      // clang-format off
      F{&P::velocity_gain_m_per_s_v, {"velocity_gain", "velocity_gain_m_per_s_v", "g", "m/(s V)", "velocity per volt", "docs/extending.md", K::plant, 1e-6, 1e3}},
      F{&P::velocity_lag_s, {"velocity_lag", "velocity_lag_s", "tau", "s", "lag of the velocity", "docs/extending.md", K::plant, 1e-6, 10}},
      // clang-format on
  };
  return joined(own, sensor_rows<FirstOrderParameters, T>(),
                controller_rows<FirstOrderParameters, T>());
}

template <typename T>
inline constexpr auto kFirstOrderFields = first_order_fields<T>();

/// An actuator whose velocity follows its command with a lag, such as an electric axis:
///
///   x' = v,  tau v' = g u - v
struct FirstOrderPlant {
  static constexpr std::string_view kName = "first_order";  ///< in campaign files
  static constexpr int kStates = 2;
  enum State { position, velocity };
  template <typename T>
  using Parameters = FirstOrderParameters<T>;
  template <typename C>
  struct Coefficients : Parameters<C> {
    Coefficients() = default;
    explicit Coefficients(const Parameters<C>& p) : Parameters<C>(p) {}
  };
  template <typename T>
  static constexpr const auto& fields() {
    return kFirstOrderFields<T>;
  }
  static constexpr std::array<StateRow, kStates> kStateRows{kPistonPosition, kPistonVelocity};

  static constexpr std::optional<int> state_of(Output output) {
    if (output == Output::position) return position;
    if (output == Output::velocity) return velocity;
    return std::nullopt;
  }

  static bool reversible(Output /*output*/, const PresentTerms& /*terms*/) { return true; }

  template <typename X, std::size_t M, typename C>
  static std::array<X, kStates> derivative(const std::array<X, M>& x, const PlantInput<X>& in,
                                           const Coefficients<C>& p,
                                           const PresentTerms& /*terms*/) {
    const X& v = x[velocity];
    return {v, (in.spool_command_v * p.velocity_gain_m_per_s_v - v) / p.velocity_lag_s};
  }

  /// It has no outputs other than position and velocity.
  template <typename X, std::size_t M, typename C>
  static X output(Output /*output*/, const std::array<X, M>& /*x*/, const PlantInput<X>& /*in*/,
                  const Coefficients<C>& /*p*/, const PresentTerms& /*terms*/) {
    return X(0.0);
  }

  template <typename C>
  static std::array<C, kStates> rest(const PlantInput<C>& /*in*/, const Coefficients<C>& /*p*/,
                                     const PresentTerms& /*terms*/) {
    return {C(0.0), C(0.0)};
  }

  template <typename C>
  static std::array<C, kStates> initial(const PlantInput<C>& /*in*/, const Coefficients<C>& p,
                                        const PresentTerms& /*terms*/) {
    return {(p.initial_position_m - p.position_offset_m) / p.position_gain,
            p.initial_velocity_m_per_s};
  }
};

}  // namespace rigcal::model
