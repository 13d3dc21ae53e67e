#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include "model/plant/layout.hpp"
#include "model/plant/parameter.hpp"
#include "model/plant/rig.hpp"

// Kinds of quantities, which the compiler compares for every plant (parameter.cpp): whether a gain,
// a sensor or an initial value belongs to a length or an angle, a force or a torque.

namespace rigcal::model {

/// Exponents of a unit. An angle has one of its own, so that it is neither a length nor a number.
struct Dimension {
  int m = 0, kg = 0, s = 0, v = 0, rad = 0, k = 0;

  constexpr bool operator==(const Dimension&) const = default;

  constexpr Dimension times(const Dimension& other, int power) const {
    return {m + power * other.m, kg + power * other.kg,   s + power * other.s,
            v + power * other.v, rad + power * other.rad, k + power * other.k};
  }
};

constexpr Dimension dimension_of_symbol(std::string_view symbol) {
  if (symbol == "1") return {};
  if (symbol == "m") return {.m = 1};
  if (symbol == "kg") return {.kg = 1};
  if (symbol == "s") return {.s = 1};
  if (symbol == "V") return {.v = 1};
  if (symbol == "rad") return {.rad = 1};
  if (symbol == "K") return {.k = 1};
  if (symbol == "N") return {.m = 1, .kg = 1, .s = -2};
  if (symbol == "Pa") return {.m = -1, .kg = 1, .s = -2};
  throw std::invalid_argument("a unit that the tables do not use");
}

/// One factor of a unit: "m3" has the symbol "m" and the power 3.
struct UnitFactor {
  std::string_view symbol;
  int power;       ///< 1 without a digit
  int sign;        ///< -1 behind a "/"
  bool has_digit;  ///< as "1" has, which is a symbol
};

/// Takes the first factor from a unit such as "m3/(s Pa)"; std::nullopt at its end.
constexpr std::optional<UnitFactor> take_factor(std::string_view& unit, int& sign) {
  while (!unit.empty() && std::string_view(" /()").find(unit.front()) != std::string_view::npos) {
    if (unit.front() == '/') sign = -1;
    unit.remove_prefix(1);
  }
  if (unit.empty()) return std::nullopt;
  const std::size_t length = std::min(unit.find_first_of(" /()"), unit.size());
  std::string_view factor = unit.substr(0, length);
  unit.remove_prefix(length);
  const char last = factor.back();
  if (factor == "1" || last < '0' || last > '9') return UnitFactor{factor, 1, sign, false};
  factor.remove_suffix(1);
  return UnitFactor{factor, last - '0', sign, true};
}

constexpr Dimension dimension(std::string_view unit) {
  Dimension result;
  int sign = 1;
  while (const auto factor = take_factor(unit, sign))
    result = result.times(dimension_of_symbol(factor->symbol), factor->sign * factor->power);
  return result;
}

/// Whether the name of a row is its key with its unit at the end: "m3/(s Pa)" is "_m3_per_s_pa".
constexpr bool is_named_by_unit(const ParameterSpec& spec) {
  std::string_view rest = spec.name;
  bool agrees = true;
  const auto take = [&](std::string_view text) {
    for (const char c : text) {
      const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      agrees = agrees && !rest.empty() && rest.front() == lower;
      if (agrees) rest.remove_prefix(1);
    }
  };
  take(spec.key);
  std::string_view unit = spec.unit;
  int sign = 1;
  bool divided = false;
  while (const auto factor = take_factor(unit, sign)) {
    if (factor->symbol == "1") continue;
    if (factor->sign < 0 && !divided) take("_per");
    divided = factor->sign < 0;
    take("_");
    take(factor->symbol);
    const char digit = static_cast<char>('0' + factor->power);
    if (factor->has_digit) take(std::string_view(&digit, 1));
  }
  return agrees && rest.empty();
}

constexpr bool are_named_by_units(std::span<const ParameterSpec> rows) {
  return std::all_of(rows.begin(), rows.end(), is_named_by_unit);
}

/// Whether there is a row whose key is `first` and `second` together, of a kind.
constexpr bool has_kind(std::span<const ParameterSpec> rows, std::string_view first,
                        std::string_view second, const Dimension& kind) {
  for (const ParameterSpec& row : rows) {
    if (row.key.size() == first.size() + second.size() && row.key.starts_with(first) &&
        row.key.ends_with(second))
      return dimension(row.unit) == kind;
  }
  return false;
}

/// Kind of a quantity that a plant has as a state or an output; std::nullopt for another name.
constexpr std::optional<Dimension> kind_of(std::string_view quantity,
                                           std::span<const StateRow> states) {
  if (quantity == "payload_acceleration") quantity = "acceleration";
  for (const StateRow& state : states) {
    if (state.name == quantity) return dimension(state.unit);
  }
  for (const FeedbackRow& loop : kFeedbacks) {
    if (loop.name == quantity) return dimension(loop.unit);
  }
  // Outputs of a plant whose state is only their difference.
  for (const StateRow& pressure : {kPressureA, kPressureB}) {
    if (pressure.name == quantity) return dimension(pressure.unit);
  }
  return std::nullopt;
}

/// Whether gain, lag, largest reading and offset of every sensor fit its quantity.
constexpr bool sensors_agree(std::span<const ParameterSpec> rows,
                             std::span<const StateRow> states) {
  constexpr std::string_view kGain = "_gain";
  for (const ParameterSpec& row : rows) {
    if (row.kind != ParameterKind::sensor || !row.key.ends_with(kGain)) continue;
    const std::string_view name = row.key.substr(0, row.key.size() - kGain.size());
    const auto kind = kind_of(name, states);
    if (!kind || dimension(row.unit) != Dimension{} ||
        !has_kind(rows, name, "_lag", dimension("s")) || !has_kind(rows, name, "_maximum", *kind) ||
        !has_kind(rows, name, "_offset", *kind))
      return false;
  }
  return true;
}

/// Whether every initial value has the kind of its state.
constexpr bool initial_values_agree(std::span<const ParameterSpec> rows,
                                    std::span<const StateRow> states) {
  constexpr std::string_view kInitial = "initial_";
  for (const ParameterSpec& row : rows) {
    if (row.kind != ParameterKind::initial) continue;
    if (!row.key.starts_with(kInitial)) return false;
    const std::string_view name = row.key.substr(kInitial.size());
    const auto kind =
        name == "integral" ? std::optional(dimension(kIntegral.unit)) : kind_of(name, states);
    if (!kind || dimension(row.unit) != *kind) return false;
  }
  return true;
}

/// Whether the gains of every loop that a plant has turn its quantity into a voltage, and the
/// states of its filters have the kind of what they filter.
constexpr bool gains_agree(std::span<const ParameterSpec> rows, std::span<const StateRow> states) {
  for (std::size_t i = 0; i < kFeedbackCount; ++i) {
    const FeedbackRow& loop = kFeedbacks[i];
    const bool has = std::any_of(rows.begin(), rows.end(),
                                 [&](const ParameterSpec& row) { return row.key == loop.kp; });
    if (!has) continue;
    // Three-variable control acts on the motion, also with an acceleration as its reference.
    const bool three = !loop.acceleration.empty();
    const Dimension kind = dimension(three ? states[0].unit : loop.unit);
    const auto by = [&](std::string_view key, int seconds) {
      const Dimension gain = dimension("V").times(kind, -1).times(dimension("s"), seconds);
      return key.empty() || has_kind(rows, key, "", gain);
    };
    if (!by(loop.kp, 0) || !by(loop.ki, -1) || !by(loop.kd, 1) || !by(loop.acceleration, 2) ||
        !by(loop.velocity_feedforward, 1) || !by(loop.acceleration_feedforward, 2))
      return false;
    if (!three && dimension(kFilteredError.at(i).unit) != kind) return false;
    const bool turns = kind == dimension("rad");
    if (!loop.velocity_feedforward.empty() &&
        (dimension((turns ? kFilteredAngleReference : kFilteredReference).unit) != kind ||
         dimension((turns ? kFilteredAngularRate : kFilteredRate).unit) !=
             kind.times(dimension("s"), -1)))
      return false;
  }
  return true;
}

/// Whether the second state is the rate of the first, the motion of the plant.
constexpr bool motion_agrees(std::span<const StateRow> states) {
  return dimension(states[1].unit) == dimension(states[0].unit).times(dimension("s"), -1);
}

}  // namespace rigcal::model
