#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// Maps a value between its bounds to a coordinate z in [0, 1] that is linear in the value or in
/// its logarithm.
struct UnitInterval {
  double lower = 0.0;
  double upper = 1.0;
  bool logarithmic = false;

  double value(double z) const;
  double place(double value) const;
  /// d value / d z
  double slope(double z) const;
};

/// Up to this number of unknowns, all are treated as shared.
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

/// Returns true if the condition or its leak level has its own known value for a parameter. Such a
/// value takes precedence over any value of the rig, including a fitted one.
bool known_in(const datasets::Campaign& campaign, const datasets::Condition& condition, int index);

/// Returns the level to which a value with this scope belongs in a condition; empty for the rig.
///
/// @throws InputError  if the scope is leak_level and the condition has no leak level
std::string level_in(const datasets::Condition& condition, datasets::Scope scope,
                     std::string_view parameter);

/// The unknowns of a set of conditions in a fixed order (table index, then first appearance of the
/// level), with a record of which act in which condition. The optimiser's coordinates z range from
/// 0 to 1. They are linear in the value, or in its logarithm if both bounds are positive and span
/// more than a decade.
class ParameterMap {
 public:
  /// @param conditions     the conditions of the problem
  /// @param nuisance_only  true in validation: only nuisance parameters are unknown
  /// @param extra          unknowns in addition to those of the campaign (initial states of
  ///                       conditions)
  /// @param repeats        number of repeats averaged in the record of each condition; empty: 1
  /// @throws InputError    if a start is outside its bounds, bounds are not finite or empty, or a
  ///                       condition lacks the leak level that a scope needs
  ParameterMap(const datasets::Campaign& campaign,
               const std::vector<const datasets::Condition*>& conditions, bool nuisance_only,
               const std::vector<Unknown>& extra = {}, const std::vector<int>& repeats = {});

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// Indices in unknowns() of the unknowns that act in a condition, in the order of their table
  /// indices.
  const std::vector<int>& acting(std::size_t condition) const { return acting_[condition]; }
  /// Which unknowns belong to a single condition. If there are few unknowns, all are shared,
  /// because dense matrices are then cheap.
  const ArrowLayout& layout() const { return layout_; }

  double to_physical(int unknown, double z) const;
  double to_unit(int unknown, double value) const;
  /// d value / d z
  double slope(int unknown, double z) const;
  /// Residual of the prior on an unknown, and d residual / d z; both are zero if it has no prior.
  double prior_residual(int unknown, double z) const;
  double prior_slope(int unknown, double z) const;

 private:
  std::vector<Unknown> unknowns_;
  std::vector<std::vector<int>> acting_;
  ArrowLayout layout_;
};

}  // namespace rigcal::calib
