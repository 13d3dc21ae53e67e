#include "diagnosis/record/healthy_effects.hpp"

#include <algorithm>
#include <tuple>

#include "diagnosis/record/steady_leak.hpp"

namespace rigcal::diagnosis {
namespace {

auto fields(const model::Rig& rig) {
  // Fails to compile if a field is added.
  const auto& [plant, controller, initial, feedback, before, pilot] = rig;
  return std::tuple(plant, controller, initial, feedback, before, pilot);
}

auto fields(const calib::Effect& effect) {
  const auto& [kind, index, sign, range, middle, curved, secant, followed, about] = effect;
  return std::tuple(kind, index, sign, range, middle, curved, secant, followed, about.key,
                    about.size);
}

auto signal_of(const datasets::Condition& condition) {
  return std::tuple(condition.waveform, condition.frequency_hz, condition.amplitude);
}

bool are_alike(const std::vector<calib::Effect>& a, const std::vector<calib::Effect>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return fields(one) == fields(other);
  });
}

}  // namespace

bool HealthyEffects::Known::serves(const Known& other) const {
  return signal_of(condition) == signal_of(other.condition) && fields(rig) == fields(other.rig) &&
         values.value == other.values.value && values.given == other.values.given &&
         drive_begins_s == other.drive_begins_s && time_s == other.time_s &&
         outputs == other.outputs && are_alike(acting, other.acting);
}

HealthyEffects::Changes HealthyEffects::of(const calib::ProblemCondition& condition,
                                           const model::ParameterValues& values,
                                           const std::vector<calib::Effect>& acting,
                                           const std::function<calib::EffectChanges()>& simulate) {
  const auto simulated = [&] { return std::make_shared<const calib::EffectChanges>(simulate()); };
  if (!has_periodic_state(condition)) return simulated();
  Known wanted{*condition.condition,     condition.rig,     values, condition.inputs.drive_begins_s,
               condition.record->time_s, condition.outputs, acting, nullptr};
  {
    const std::lock_guard lock(mutex_);
    for (const Known& each : known_)
      if (each.serves(wanted)) return each.changes;
  }
  wanted.changes = simulated();
  const std::lock_guard lock(mutex_);
  known_.push_back(wanted);
  return wanted.changes;
}

}  // namespace rigcal::diagnosis
