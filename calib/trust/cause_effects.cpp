#include "calib/trust/cause_effects.hpp"

#include "calib/problem/repeat_inputs.hpp"
#include "calib/trust/known_uncertainty.hpp"

namespace rigcal::calib {

CauseEffects::CauseEffects(const Problem& problem, std::span<const double> z)
    : problem_(problem), z_(z), effects_(problem.conditions.size()) {
  for (const char* key : {"supply_pressure", "bulk_modulus"}) {
    const int index = model::parameter_index(problem.campaign->rig.plant, key);
    const auto* setting = problem.campaign->setting(index);
    if (index < 0 || (setting != nullptr && setting->between_repeats)) continue;
    causes_.emplace_back(key);
    indices_.push_back(index);
  }
}

std::vector<double> CauseEffects::values(std::size_t condition) const {
  const auto all = problem_.values_at(condition, z_);
  std::vector<double> result;
  for (const int index : indices_) result.push_back(all.value[static_cast<std::size_t>(index)]);
  return result;
}

const Eigen::MatrixXd& CauseEffects::of(std::size_t condition) {
  auto& effects = effects_[condition];
  if (!effects) effects = known_sensitivities(problem_, condition, z_, indices_);
  return *effects;
}

Eigen::MatrixXd CauseEffects::explained_by_inputs(std::size_t condition) const {
  return calib::explained_by_inputs(problem_, condition, z_);
}

}  // namespace rigcal::calib
