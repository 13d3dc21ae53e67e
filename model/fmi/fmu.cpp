// The functions of FMI 2.0. Each calls a method of an FmuInstance. Exceptions are logged and
// returned as fmi2Error.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "model/fmi/fmi2.hpp"
#include "model/fmi/fmu_instance.hpp"

namespace {

using rigcal::model::FmuInstance;
using rigcal::model::InstanceState;

struct Component {
  std::string name;
  fmi2CallbackFunctions callbacks;
  std::unique_ptr<FmuInstance> instance;
};

void log(const fmi2CallbackFunctions& callbacks, const std::string& name,
         const std::string& message) {
  if (callbacks.logger != nullptr)
    callbacks.logger(callbacks.componentEnvironment, name.c_str(), fmi2Error, "logStatusError",
                     "%s", message.c_str());
}

/// Runs `action` on the instance. An exception is logged and returned as fmi2Error.
template <typename Action>
fmi2Status call(fmi2Component c, const char* function, const Action& action) {
  if (c == nullptr) return fmi2Error;
  auto& component = *static_cast<Component*>(c);
  try {
    action(*component.instance);
    return fmi2OK;
  } catch (const std::exception& error) {
    log(component.callbacks, component.name, std::string(function) + ": " + error.what());
    return fmi2Error;
  }
}

int hexadecimal(char c) {
  constexpr const char* kDigits = "0123456789abcdef";
  const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
  const char* found = lower == '\0' ? nullptr : std::strchr(kDigits, lower);
  return found == nullptr ? -1 : static_cast<int>(found - kDigits);
}

/// Returns the folder that a "file:" URI names, with "%20" and the like decoded.
std::string folder_of(const char* uri) {
  if (uri == nullptr) throw std::runtime_error("fmuResourceLocation is missing");
  std::string text(uri);
  if (text.rfind("file:", 0) == 0) {
    text.erase(0, 5);
    if (text.rfind("//", 0) == 0) text.erase(0, text.find('/', 2));
  }
  std::string path;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '%' && i + 2 < text.size() && hexadecimal(text[i + 1]) >= 0 &&
                         hexadecimal(text[i + 2]) >= 0;
    path += escaped ? static_cast<char>(16 * hexadecimal(text[i + 1]) + hexadecimal(text[i + 2]))
                    : text[i];
    if (escaped) i += 2;
  }
  return path;
}

/// Answers a request for integer, boolean or string variables, which this FMU does not have.
fmi2Status none(fmi2Component c, const char* function, std::size_t count) {
  return call(c, function, [&](FmuInstance&) {
    if (count > 0) throw std::runtime_error("every variable of this FMU is real");
  });
}

fmi2Status unsupported(fmi2Component c, const char* function) {
  return call(c, function, [](FmuInstance&) {
    throw std::runtime_error("not supported, as the model description states");
  });
}

void copy(const std::vector<double>& from, double* to, std::size_t count) {
  rigcal::model::require_size(count, from.size());
  std::copy(from.begin(), from.end(), to);
}

}  // namespace

extern "C" {

const char* FMI2(fmi2GetTypesPlatform)() { return "default"; }
const char* FMI2(fmi2GetVersion)() { return "2.0"; }

fmi2Status FMI2(fmi2SetDebugLogging)(fmi2Component c, fmi2Boolean /*on*/, std::size_t /*count*/,
                                     const fmi2String /*categories*/[]) {
  // Only errors are logged, and they are always logged.
  return call(c, "fmi2SetDebugLogging", [](FmuInstance&) {});
}

fmi2Component FMI2(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid,
                                    fmi2String resources, const fmi2CallbackFunctions* functions,
                                    fmi2Boolean /*visible*/, fmi2Boolean /*logging*/) {
  const fmi2CallbackFunctions callbacks =
      functions == nullptr ? fmi2CallbackFunctions{} : *functions;
  const char* shown = name == nullptr ? "" : name;
  try {
    if (type != fmi2ModelExchange && type != fmi2CoSimulation)
      throw std::runtime_error("fmuType is neither fmi2ModelExchange nor fmi2CoSimulation");
    auto component = std::make_unique<Component>();
    component->name = shown;
    component->callbacks = callbacks;
    component->instance = std::make_unique<FmuInstance>(
        folder_of(resources), guid == nullptr ? "" : guid, type == fmi2ModelExchange);
    return component.release();
  } catch (const std::exception& error) {
    log(callbacks, shown, std::string("fmi2Instantiate: ") + error.what());
    return nullptr;
  }
}

void FMI2(fmi2FreeInstance)(fmi2Component c) { delete static_cast<Component*>(c); }

fmi2Status FMI2(fmi2SetupExperiment)(fmi2Component c, fmi2Boolean tolerance_defined,
                                     fmi2Real tolerance, fmi2Real start,
                                     fmi2Boolean /*stop_defined*/, fmi2Real /*stop*/) {
  return call(c, "fmi2SetupExperiment", [&](FmuInstance& instance) {
    instance.set_up(start, tolerance_defined != fmi2False ? &tolerance : nullptr);
  });
}

fmi2Status FMI2(fmi2EnterInitializationMode)(fmi2Component c) {
  return call(c, "fmi2EnterInitializationMode",
              [](FmuInstance& instance) { instance.enter_initialization(); });
}

fmi2Status FMI2(fmi2ExitInitializationMode)(fmi2Component c) {
  return call(c, "fmi2ExitInitializationMode",
              [](FmuInstance& instance) { instance.exit_initialization(); });
}

fmi2Status FMI2(fmi2Terminate)(fmi2Component c) {
  return call(c, "fmi2Terminate", [](FmuInstance& instance) { instance.terminate(); });
}

fmi2Status FMI2(fmi2Reset)(fmi2Component c) {
  return call(c, "fmi2Reset", [](FmuInstance& instance) { instance.reset(); });
}

fmi2Status FMI2(fmi2GetReal)(fmi2Component c, const fmi2ValueReference references[],
                             std::size_t count, fmi2Real values[]) {
  return call(c, "fmi2GetReal", [&](FmuInstance& instance) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = instance.real(references[i]);
      if (!std::isfinite(values[i]))
        throw std::runtime_error("the value of reference " + std::to_string(references[i]) +
                                 " is not finite");
    }
  });
}

fmi2Status FMI2(fmi2GetInteger)(fmi2Component c, const fmi2ValueReference /*references*/[],
                                std::size_t count, fmi2Integer /*values*/[]) {
  return none(c, "fmi2GetInteger", count);
}
fmi2Status FMI2(fmi2GetBoolean)(fmi2Component c, const fmi2ValueReference /*references*/[],
                                std::size_t count, fmi2Boolean /*values*/[]) {
  return none(c, "fmi2GetBoolean", count);
}
fmi2Status FMI2(fmi2GetString)(fmi2Component c, const fmi2ValueReference /*references*/[],
                               std::size_t count, fmi2String /*values*/[]) {
  return none(c, "fmi2GetString", count);
}

fmi2Status FMI2(fmi2SetReal)(fmi2Component c, const fmi2ValueReference references[],
                             std::size_t count, const fmi2Real values[]) {
  return call(c, "fmi2SetReal", [&](FmuInstance& instance) {
    for (std::size_t i = 0; i < count; ++i) instance.set_real(references[i], values[i]);
  });
}

fmi2Status FMI2(fmi2SetInteger)(fmi2Component c, const fmi2ValueReference /*references*/[],
                                std::size_t count, const fmi2Integer /*values*/[]) {
  return none(c, "fmi2SetInteger", count);
}
fmi2Status FMI2(fmi2SetBoolean)(fmi2Component c, const fmi2ValueReference /*references*/[],
                                std::size_t count, const fmi2Boolean /*values*/[]) {
  return none(c, "fmi2SetBoolean", count);
}
fmi2Status FMI2(fmi2SetString)(fmi2Component c, const fmi2ValueReference /*references*/[],
                               std::size_t count, const fmi2String /*values*/[]) {
  return none(c, "fmi2SetString", count);
}

fmi2Status FMI2(fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate* state) {
  return call(c, "fmi2GetFMUstate", [&](FmuInstance& instance) {
    if (*state == nullptr) {
      *state = new InstanceState(instance.state());
    } else {
      *static_cast<InstanceState*>(*state) = instance.state();
    }
  });
}

fmi2Status FMI2(fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate state) {
  return call(c, "fmi2SetFMUstate", [&](FmuInstance& instance) {
    if (state == nullptr) throw std::runtime_error("FMUstate is missing");
    instance.restore(*static_cast<InstanceState*>(state));
  });
}

fmi2Status FMI2(fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate* state) {
  return call(c, "fmi2FreeFMUstate", [&](FmuInstance&) {
    delete static_cast<InstanceState*>(*state);
    *state = nullptr;
  });
}

fmi2Status FMI2(fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate /*state*/,
                                            std::size_t* /*size*/) {
  return unsupported(c, "fmi2SerializedFMUstateSize");
}
fmi2Status FMI2(fmi2SerializeFMUstate)(fmi2Component c, fmi2FMUstate /*state*/,
                                       fmi2Byte /*bytes*/[], std::size_t /*size*/) {
  return unsupported(c, "fmi2SerializeFMUstate");
}
fmi2Status FMI2(fmi2DeSerializeFMUstate)(fmi2Component c, const fmi2Byte /*bytes*/[],
                                         std::size_t /*size*/, fmi2FMUstate* /*state*/) {
  return unsupported(c, "fmi2DeSerializeFMUstate");
}
fmi2Status FMI2(fmi2GetDirectionalDerivative)(
    fmi2Component c, const fmi2ValueReference /*unknown*/[], std::size_t /*unknown_count*/,
    const fmi2ValueReference /*known*/[], std::size_t /*known_count*/,
    const fmi2Real /*change_of_known*/[], fmi2Real /*change_of_unknown*/[]) {
  return unsupported(c, "fmi2GetDirectionalDerivative");
}

fmi2Status FMI2(fmi2EnterEventMode)(fmi2Component c) {
  return call(c, "fmi2EnterEventMode", [](FmuInstance& instance) { instance.enter_event_mode(); });
}

fmi2Status FMI2(fmi2NewDiscreteStates)(fmi2Component c, fmi2EventInfo* info) {
  return call(c, "fmi2NewDiscreteStates", [&](FmuInstance& instance) {
    const bool ticked = instance.new_discrete_states();
    const double next = instance.next_tick_s();
    const bool sampled = next < 1e300;
    *info = {fmi2False,
             fmi2False,
             fmi2False,
             ticked ? fmi2True : fmi2False,
             sampled ? fmi2True : fmi2False,
             sampled ? next : 0.0};
  });
}

fmi2Status FMI2(fmi2EnterContinuousTimeMode)(fmi2Component c) {
  return call(c, "fmi2EnterContinuousTimeMode",
              [](FmuInstance& instance) { instance.enter_continuous_mode(); });
}

fmi2Status FMI2(fmi2CompletedIntegratorStep)(fmi2Component c, fmi2Boolean /*no_return*/,
                                             fmi2Boolean* enter_event_mode,
                                             fmi2Boolean* terminate) {
  return call(c, "fmi2CompletedIntegratorStep", [&](FmuInstance&) {
    *enter_event_mode = fmi2False;
    *terminate = fmi2False;
  });
}

fmi2Status FMI2(fmi2SetTime)(fmi2Component c, fmi2Real time) {
  return call(c, "fmi2SetTime", [&](FmuInstance& instance) { instance.set_time(time); });
}

fmi2Status FMI2(fmi2SetContinuousStates)(fmi2Component c, const fmi2Real states[],
                                         std::size_t count) {
  return call(c, "fmi2SetContinuousStates",
              [&](FmuInstance& instance) { instance.set_states(states, count); });
}

fmi2Status FMI2(fmi2GetDerivatives)(fmi2Component c, fmi2Real derivatives[], std::size_t count) {
  return call(c, "fmi2GetDerivatives",
              [&](FmuInstance& instance) { copy(instance.derivatives(), derivatives, count); });
}

fmi2Status FMI2(fmi2GetEventIndicators)(fmi2Component c, fmi2Real indicators[], std::size_t count) {
  return call(c, "fmi2GetEventIndicators",
              [&](FmuInstance& instance) { copy(instance.indicators(), indicators, count); });
}

fmi2Status FMI2(fmi2GetContinuousStates)(fmi2Component c, fmi2Real states[], std::size_t count) {
  return call(c, "fmi2GetContinuousStates",
              [&](FmuInstance& instance) { copy(instance.states(), states, count); });
}

fmi2Status FMI2(fmi2GetNominalsOfContinuousStates)(fmi2Component c, fmi2Real nominals[],
                                                   std::size_t count) {
  return call(c, "fmi2GetNominalsOfContinuousStates",
              [&](FmuInstance& instance) { copy(instance.nominals(), nominals, count); });
}

fmi2Status FMI2(fmi2SetRealInputDerivatives)(fmi2Component c, const fmi2ValueReference references[],
                                             std::size_t count, const fmi2Integer orders[],
                                             const fmi2Real values[]) {
  return call(c, "fmi2SetRealInputDerivatives", [&](FmuInstance& instance) {
    for (std::size_t i = 0; i < count; ++i)
      instance.set_input_derivative(references[i], orders[i], values[i]);
  });
}

fmi2Status FMI2(fmi2GetRealOutputDerivatives)(fmi2Component c,
                                              const fmi2ValueReference /*references*/[],
                                              std::size_t /*count*/, const fmi2Integer /*orders*/[],
                                              fmi2Real /*values*/[]) {
  return unsupported(c, "fmi2GetRealOutputDerivatives");
}

fmi2Status FMI2(fmi2DoStep)(fmi2Component c, fmi2Real time, fmi2Real step,
                            fmi2Boolean /*no_return*/) {
  return call(c, "fmi2DoStep", [&](FmuInstance& instance) { instance.step(time, step); });
}

fmi2Status FMI2(fmi2CancelStep)(fmi2Component c) { return unsupported(c, "fmi2CancelStep"); }

fmi2Status FMI2(fmi2GetStatus)(fmi2Component c, fmi2StatusKind /*kind*/, fmi2Status* /*value*/) {
  return unsupported(c, "fmi2GetStatus");  // no step is ever pending
}

fmi2Status FMI2(fmi2GetRealStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Real* value) {
  return call(c, "fmi2GetRealStatus", [&](FmuInstance& instance) {
    if (kind != fmi2LastSuccessfulTime) throw std::runtime_error("expected fmi2LastSuccessfulTime");
    *value = instance.state().time_s;
  });
}

fmi2Status FMI2(fmi2GetIntegerStatus)(fmi2Component c, fmi2StatusKind /*kind*/,
                                      fmi2Integer* /*value*/) {
  return unsupported(c, "fmi2GetIntegerStatus");
}

fmi2Status FMI2(fmi2GetBooleanStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Boolean* value) {
  return call(c, "fmi2GetBooleanStatus", [&](FmuInstance&) {
    if (kind != fmi2Terminated) throw std::runtime_error("expected fmi2Terminated");
    *value = fmi2False;
  });
}

fmi2Status FMI2(fmi2GetStringStatus)(fmi2Component c, fmi2StatusKind /*kind*/,
                                     fmi2String* /*value*/) {
  return unsupported(c, "fmi2GetStringStatus");
}

}  // extern "C"
