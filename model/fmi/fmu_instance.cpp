#include "model/fmi/fmu_instance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "model/fmi/references.hpp"

namespace rigcal::model {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Largest distance to a tick, in periods, at which it counts as due. The times that an importer
/// adds up are rounded.
constexpr double kSamePart = 1e-6;

double rounding_s(double time_s) {
  return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(time_s);
}

const char* words(Phase phase) {
  switch (phase) {
    case Phase::instantiated:
      return "instantiated";
    case Phase::initialization:
      return "in initialization mode";
    case Phase::event:
      return "in event mode";
    case Phase::continuous:
      return "in continuous-time mode";
    case Phase::stepping:
      return "initialized for co-simulation";
    case Phase::terminated:
      return "terminated";
  }
  return "";
}

/// Nine significant digits; std::to_string would write a microvolt as zero.
std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

void require_finite(double value, const std::string& what) {
  if (!std::isfinite(value))
    throw std::runtime_error(what + ": found " + digits(value) + ", expected a finite number");
}

InstanceState start_of(const ExportedRig& rig) {
  InstanceState state;
  state.values = rig.values;
  state.tolerance = rig.tolerance;
  if (parameter_index(rig.rig.plant, "external_force") >= 0)
    state.inputs.external_load.value = rig.values["external_force"];
  state.inputs.supply_pressure_pa.value = rig.values["supply_pressure"];
  if (parameter_index(rig.rig.plant, "tank_pressure") >= 0)
    state.inputs.tank_pressure_pa.value = rig.values["tank_pressure"];
  return state;
}

}  // namespace

void require_size(std::size_t count, std::size_t expected) {
  if (count != expected)
    throw std::runtime_error("found room for " + std::to_string(count) + " numbers, expected " +
                             std::to_string(expected));
}

FmuInstance::FmuInstance(const std::filesystem::path& resources, const std::string& guid,
                         bool exchange)
    : rig_(read_exported_rig(resources / kRigFile)), exchange_(exchange) {
  if (guid != rig_.guid)
    throw std::runtime_error("the GUID is " + guid + ", expected " + rig_.guid + " as in " +
                             (resources / kRigFile).string());
  equations_ = make_equations(rig_);
  parameters_ = exported_parameters(rig_);
  state_ = start_of(rig_);
}

void FmuInstance::set_up(double start_s, const double* tolerance) {
  require_phase({Phase::instantiated});
  require_finite(start_s, "startTime");
  if (tolerance != nullptr) {
    if (!(*tolerance > 0.0 && *tolerance < 0.1))
      throw std::runtime_error("tolerance: found " + digits(*tolerance) +
                               ", expected one between 0 and 0.1");
    state_.tolerance = *tolerance;
  }
  state_.start_s = start_s;
  state_.time_s = start_s;
}

void FmuInstance::enter_initialization() {
  require_phase({Phase::instantiated});
  state_.phase = Phase::initialization;
  stale_ = true;
}

void FmuInstance::exit_initialization() {
  require_phase({Phase::initialization});
  refresh();
  state_.phase = exchange_ ? Phase::event : Phase::stepping;
}

void FmuInstance::enter_event_mode() {
  require_phase({Phase::event, Phase::continuous});
  state_.phase = Phase::event;
}

void FmuInstance::enter_continuous_mode() {
  require_phase({Phase::event});
  state_.phase = Phase::continuous;
}

void FmuInstance::terminate() {
  require_phase({Phase::event, Phase::continuous, Phase::stepping});
  state_.phase = Phase::terminated;
}

void FmuInstance::reset() { restore(start_of(rig_)); }

double FmuInstance::real(unsigned reference) {
  if (reference < kInputReference + kInputCount) return input(reference).value;
  if (const auto row = parameter_row(reference)) return state_.values.value[*row];
  if (reference < kParameterReference) {
    if (state_.phase == Phase::instantiated)
      throw std::runtime_error("states and outputs are available from initialization mode on");
    refresh();
    const std::size_t states = state_.x.size();
    std::vector<double> x = state_.x;
    // In co-simulation, the importer reads the controller's output for the inputs of this instant.
    if (state_.phase == Phase::stepping && tick_is_due(state_, state_.time_s))
      equations_->tick(x, 0.0);
    const auto is_in = [reference](unsigned first, std::size_t count) {
      return reference >= first && reference < first + count;
    };
    if (is_in(kStateReference, states)) return x[reference - kStateReference];
    if (is_in(kDerivativeReference, states))
      return equations_->derivatives(x)[reference - kDerivativeReference];
    if (is_in(kOutputReference, kAllOutputs.size()))
      return equations_->output(kAllOutputs[reference - kOutputReference], x);
  }
  throw std::runtime_error("no variable has the value reference " + std::to_string(reference));
}

void FmuInstance::set_real(unsigned reference, double value) {
  const std::string what = "value reference " + std::to_string(reference);
  if (reference < kInputReference + kInputCount) {
    require_phase({Phase::instantiated, Phase::initialization, Phase::event, Phase::continuous,
                   Phase::stepping});
    require_finite(value, what);
    input(reference).value = value;
    stale_ = true;
    return;
  }
  const auto row = parameter_row(reference);
  if (!row) throw std::runtime_error(what + ": no input or parameter has it");
  const ParameterSpec& spec = parameter_table(rig_.rig.plant)[*row];
  const std::string key(spec.key);
  require_finite(value, key);
  if (value < spec.lower || value > spec.upper)
    throw std::runtime_error(key + ": found " + digits(value) + ", expected " + digits(spec.lower) +
                             " to " + digits(spec.upper) + " " + std::string(spec.unit));
  if (is_tunable(spec)) {
    require_phase({Phase::instantiated, Phase::initialization, Phase::event, Phase::stepping});
  } else {
    require_phase({Phase::instantiated, Phase::initialization});
  }
  state_.values.value[*row] = value;
  stale_ = true;
}

void FmuInstance::set_input_derivative(unsigned reference, int order, double value) {
  require_phase({Phase::stepping});
  if (order != 1)
    throw std::runtime_error("derivatives of inputs: found order " + std::to_string(order) +
                             ", expected 1");
  require_finite(value, "derivative of value reference " + std::to_string(reference));
  input(reference).slope_per_s = value;
  stale_ = true;
}

void FmuInstance::set_time(double time_s) {
  require_phase({Phase::event, Phase::continuous});
  require_finite(time_s, "time");
  state_.time_s = time_s;
}

void FmuInstance::set_states(const double* x, std::size_t count) {
  require_phase({Phase::continuous, Phase::event});
  require_size(count, state_.x.size());
  for (std::size_t i = 0; i < count; ++i) require_finite(x[i], "state " + std::to_string(i));
  std::copy_n(x, count, state_.x.begin());
}

const std::vector<double>& FmuInstance::states() {
  require_phase(
      {Phase::initialization, Phase::event, Phase::continuous, Phase::stepping, Phase::terminated});
  refresh();
  return state_.x;
}

std::vector<double> FmuInstance::derivatives() {
  const std::vector<double>& x = states();
  std::vector<double> dx = equations_->derivatives(x);
  for (std::size_t i = 0; i < dx.size(); ++i)
    require_finite(dx[i], "derivative of state " + std::to_string(i));
  return dx;
}

std::vector<double> FmuInstance::indicators() {
  const std::vector<double>& x = states();
  return equations_->indicators(x);
}

std::vector<double> FmuInstance::nominals() {
  std::vector<double> nominals;
  for (const StateDescription& state : describe_states(rig_, equations_->layout()))
    nominals.push_back(state.nominal);
  return nominals;
}

bool FmuInstance::new_discrete_states() {
  require_phase({Phase::event});
  refresh();
  if (!tick_is_due(state_, state_.time_s)) return false;
  equations_->tick(state_.x, 0.0);
  ++state_.ticks;
  return true;
}

double FmuInstance::next_tick_s() const { return next_tick_s(state_); }

double FmuInstance::next_tick_s(const InstanceState& state) const {
  if (!equations_->layout().sampled()) return kNever;
  return state.start_s + static_cast<double>(state.ticks) * state.values["sample_time"];
}

double FmuInstance::slack_s(const InstanceState& state, double time_s) const {
  return kSamePart * state.values["sample_time"] + rounding_s(time_s);
}

bool FmuInstance::tick_is_due(const InstanceState& state, double time_s) const {
  return next_tick_s(state) <= time_s + slack_s(state, time_s);
}

void FmuInstance::step(double time_s, double step_s) {
  require_phase({Phase::stepping});
  require_finite(time_s, "currentCommunicationPoint");
  require_finite(step_s, "communicationStepSize");
  if (!(step_s > 0.0))
    throw std::runtime_error("communicationStepSize: found " + digits(step_s) +
                             ", expected one above 0");
  if (std::abs(time_s - state_.time_s) > 1e-3 * step_s + rounding_s(time_s))
    throw std::runtime_error("currentCommunicationPoint: found " + digits(time_s) +
                             " s, expected " + digits(state_.time_s) +
                             " s, where the last step ended");
  InstanceState after = state_;
  equations_->set(after.values, after.inputs, step_s);
  for (double t = 0.0; t < step_s;) {
    while (tick_is_due(after, time_s + t)) {
      equations_->tick(after.x, t);
      ++after.ticks;
    }
    // A tick at the end of the step waits for the inputs of the next step.
    const double tick_s = next_tick_s(after) - time_s;
    const double until = tick_s < step_s - slack_s(after, time_s) ? tick_s : step_s;
    equations_->advance(after.x, after.memory, t, until, after.tolerance);
    t = until;
  }
  for (Ramp* ramp : {&after.inputs.drive, &after.inputs.external_load,
                     &after.inputs.supply_pressure_pa, &after.inputs.tank_pressure_pa})
    *ramp = {ramp->value + ramp->slope_per_s * step_s, 0.0};
  after.time_s = time_s + step_s;
  state_ = std::move(after);
  stale_ = true;
}

void FmuInstance::restore(const InstanceState& state) {
  state_ = state;
  stale_ = true;
}

void FmuInstance::require_phase(std::initializer_list<Phase> allowed) const {
  if (std::find(allowed.begin(), allowed.end(), state_.phase) != allowed.end()) return;
  std::string expected;
  for (const Phase phase : allowed)
    expected += (expected.empty() ? "" : " or ") + std::string(words(phase));
  throw std::runtime_error(std::string("the instance is ") + words(state_.phase) + ", expected " +
                           expected);
}

std::optional<std::size_t> FmuInstance::parameter_row(unsigned reference) const {
  if (reference < kParameterReference) return std::nullopt;
  const std::size_t row = reference - kParameterReference;
  const bool known = std::any_of(parameters_.begin(), parameters_.end(), [row](int index) {
    return static_cast<std::size_t>(index) == row;
  });
  return known ? std::optional(row) : std::nullopt;
}

Ramp& FmuInstance::input(unsigned reference) {
  switch (reference) {
    case 0:
      return state_.inputs.drive;
    case 1:
      return state_.inputs.external_load;
    case 2:
      return state_.inputs.supply_pressure_pa;
    case 3:
      if (parameter_index(rig_.rig.plant, "tank_pressure") >= 0)
        return state_.inputs.tank_pressure_pa;
      break;
    default:
      break;
  }
  throw std::runtime_error("no input has the value reference " + std::to_string(reference));
}

void FmuInstance::refresh() {
  if (!stale_) return;
  equations_->set(state_.values, state_.inputs, 1.0);
  if (state_.phase == Phase::initialization) state_.x = equations_->initial();
  stale_ = false;
}

}  // namespace rigcal::model
