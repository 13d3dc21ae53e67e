#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// A value between its bounds as a coordinate z in [0, 1], linear in it or in its logarithm.
struct UnitInterval {
  double lower = 0.0;
  double upper = 1.0;
  bool logarithmic = false;

  double value(double z) const;
  double place(double value) const;
  /// d value / d z
  double slope(double z) const;
};

/// Number of unknowns up to which all are shared.
inline constexpr std::size_t kMostTogether = 32;

/// One unknown of the fit: a parameter of the rig, of one leak level, or of one condition.
struct Unknown {
  int index = 0;  ///< row of the plant's parameter table
  datasets::Scope scope = datasets::Scope::rig;
  std::string level;  ///< leak level or condition; empty for the rig
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  std::optional<datasets::Prior> prior;
  bool nuisance = false;
};

/// Whether the condition, or its leak level, has a known value of its own for a parameter. It has
/// priority over any value of the rig, including a fitted one.
bool known_in(const datasets::Campaign& campaign, const datasets::Condition& condition, int index);

/// The level of a value of this scope in a condition; empty for the rig.
///
/// @throws InputError  scope leak_level, and the condition has none
std::string level_in(const datasets::Condition& condition, datasets::Scope scope,
                     std::string_view parameter);

/// "mass_kg", "leakage_coefficient (leak level 33 %)": a parameter with whose it is.
std::string parameter_name(const model::ParameterSpec& spec, datasets::Scope scope,
                           const std::string& level);

/// The unknowns of a set of conditions, in a fixed order (table index, then first appearance of the
/// level), and which of them act in which condition. Optimiser coordinates z are in [0, 1]: linear
/// in the bounds, or in their logarithms where both are positive and span more than a decade.
class ParameterMap {
 public:
  /// @param conditions     the conditions of the problem
  /// @param nuisance_only  true in validation: only nuisance parameters are unknown
  /// @param extra          unknowns in addition to those of the campaign (initial states of
  ///                       conditions)
  /// @param repeats        number of repeats averaged in the record of each condition; empty: 1
  /// @throws InputError    a start outside its bounds, bounds that are not finite or empty, a
  ///                       condition without the leak level that a scope needs
  ParameterMap(const datasets::Campaign& campaign,
               const std::vector<const datasets::Condition*>& conditions, bool nuisance_only,
               const std::vector<Unknown>& extra = {}, const std::vector<int>& repeats = {});

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// Positions in unknowns() that act in condition i, in the order of their table index.
  const std::vector<int>& acting(std::size_t condition) const { return acting_[condition]; }
  /// Which of them a condition has for itself. With few unknowns all are shared: dense matrices
  /// cost nothing then.
  const ArrowLayout& layout() const { return layout_; }

  double to_physical(int unknown, double z) const;
  double to_unit(int unknown, double value) const;
  /// d value / d z
  double slope(int unknown, double z) const;
  /// Residual of the prior of an unknown, and d residual / d z; zero where it has none.
  double prior_residual(int unknown, double z) const;
  double prior_slope(int unknown, double z) const;

 private:
  std::vector<Unknown> unknowns_;
  std::vector<std::vector<int>> acting_;
  ArrowLayout layout_;
};

}  // namespace rigcal::calib
