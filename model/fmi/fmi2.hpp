#pragma once

#include <cstddef>

// Types and functions of the Functional Mock-up Interface 2.0 that an FMU in C++ needs, with the
// names from the standard (fmi-standard.org, sections 2.1, 3.2 and 4.2).

/// Prepends FMI2_FUNCTION_PREFIX to the name of each function. Sources that are linked statically
/// rather than loaded need the prefix.
#ifdef FMI2_FUNCTION_PREFIX
#define RIGCAL_FMI2_JOINED(prefix, name) prefix##name
#define RIGCAL_FMI2_EXPANDED(prefix, name) RIGCAL_FMI2_JOINED(prefix, name)
#define FMI2(name) RIGCAL_FMI2_EXPANDED(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI2(name) name
#endif

#ifdef _WIN32
#define FMI2_EXPORT __declspec(dllexport)
#else
#define FMI2_EXPORT __attribute__((visibility("default")))
#endif

extern "C" {

using fmi2Component = void*;
using fmi2ComponentEnvironment = void*;
using fmi2FMUstate = void*;
using fmi2ValueReference = unsigned int;
using fmi2Real = double;
using fmi2Integer = int;
using fmi2Boolean = int;
using fmi2Char = char;
using fmi2String = const fmi2Char*;
using fmi2Byte = char;

inline constexpr fmi2Boolean fmi2True = 1;
inline constexpr fmi2Boolean fmi2False = 0;

enum fmi2Status { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending };
enum fmi2Type { fmi2ModelExchange, fmi2CoSimulation };
enum fmi2StatusKind { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated };

struct fmi2CallbackFunctions {
  void (*logger)(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                 fmi2String category, fmi2String message, ...);
  void* (*allocateMemory)(std::size_t count, std::size_t size);
  void (*freeMemory)(void* memory);
  void (*stepFinished)(fmi2ComponentEnvironment environment, fmi2Status status);
  fmi2ComponentEnvironment componentEnvironment;
};

struct fmi2EventInfo {
  fmi2Boolean newDiscreteStatesNeeded;
  fmi2Boolean terminateSimulation;
  fmi2Boolean nominalsOfContinuousStatesChanged;
  fmi2Boolean valuesOfContinuousStatesChanged;
  fmi2Boolean nextEventTimeDefined;
  fmi2Real nextEventTime;
};

// For both interfaces.
FMI2_EXPORT const char* FMI2(fmi2GetTypesPlatform)();
FMI2_EXPORT const char* FMI2(fmi2GetVersion)();
FMI2_EXPORT fmi2Status FMI2(fmi2SetDebugLogging)(fmi2Component c, fmi2Boolean on, std::size_t count,
                                                 const fmi2String categories[]);
FMI2_EXPORT fmi2Component FMI2(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid,
                                                fmi2String resources,
                                                const fmi2CallbackFunctions* functions,
                                                fmi2Boolean visible, fmi2Boolean logging);
FMI2_EXPORT void FMI2(fmi2FreeInstance)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2SetupExperiment)(fmi2Component c, fmi2Boolean tolerance_defined,
                                                 fmi2Real tolerance, fmi2Real start,
                                                 fmi2Boolean stop_defined, fmi2Real stop);
FMI2_EXPORT fmi2Status FMI2(fmi2EnterInitializationMode)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2ExitInitializationMode)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2Terminate)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2Reset)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2GetReal)(fmi2Component c, const fmi2ValueReference references[],
                                         std::size_t count, fmi2Real values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2GetInteger)(fmi2Component c, const fmi2ValueReference references[],
                                            std::size_t count, fmi2Integer values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2GetBoolean)(fmi2Component c, const fmi2ValueReference references[],
                                            std::size_t count, fmi2Boolean values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2GetString)(fmi2Component c, const fmi2ValueReference references[],
                                           std::size_t count, fmi2String values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2SetReal)(fmi2Component c, const fmi2ValueReference references[],
                                         std::size_t count, const fmi2Real values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2SetInteger)(fmi2Component c, const fmi2ValueReference references[],
                                            std::size_t count, const fmi2Integer values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2SetBoolean)(fmi2Component c, const fmi2ValueReference references[],
                                            std::size_t count, const fmi2Boolean values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2SetString)(fmi2Component c, const fmi2ValueReference references[],
                                           std::size_t count, const fmi2String values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate* state);
FMI2_EXPORT fmi2Status FMI2(fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate state);
FMI2_EXPORT fmi2Status FMI2(fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate* state);
FMI2_EXPORT fmi2Status FMI2(fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate state,
                                                        std::size_t* size);
FMI2_EXPORT fmi2Status FMI2(fmi2SerializeFMUstate)(fmi2Component c, fmi2FMUstate state,
                                                   fmi2Byte bytes[], std::size_t size);
FMI2_EXPORT fmi2Status FMI2(fmi2DeSerializeFMUstate)(fmi2Component c, const fmi2Byte bytes[],
                                                     std::size_t size, fmi2FMUstate* state);
FMI2_EXPORT fmi2Status FMI2(fmi2GetDirectionalDerivative)(
    fmi2Component c, const fmi2ValueReference unknown[], std::size_t unknown_count,
    const fmi2ValueReference known[], std::size_t known_count, const fmi2Real change_of_known[],
    fmi2Real change_of_unknown[]);

// For model exchange.
FMI2_EXPORT fmi2Status FMI2(fmi2EnterEventMode)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2NewDiscreteStates)(fmi2Component c, fmi2EventInfo* info);
FMI2_EXPORT fmi2Status FMI2(fmi2EnterContinuousTimeMode)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2CompletedIntegratorStep)(fmi2Component c, fmi2Boolean no_return,
                                                         fmi2Boolean* enter_event_mode,
                                                         fmi2Boolean* terminate);
FMI2_EXPORT fmi2Status FMI2(fmi2SetTime)(fmi2Component c, fmi2Real time);
FMI2_EXPORT fmi2Status FMI2(fmi2SetContinuousStates)(fmi2Component c, const fmi2Real states[],
                                                     std::size_t count);
FMI2_EXPORT fmi2Status FMI2(fmi2GetDerivatives)(fmi2Component c, fmi2Real derivatives[],
                                                std::size_t count);
FMI2_EXPORT fmi2Status FMI2(fmi2GetEventIndicators)(fmi2Component c, fmi2Real indicators[],
                                                    std::size_t count);
FMI2_EXPORT fmi2Status FMI2(fmi2GetContinuousStates)(fmi2Component c, fmi2Real states[],
                                                     std::size_t count);
FMI2_EXPORT fmi2Status FMI2(fmi2GetNominalsOfContinuousStates)(fmi2Component c, fmi2Real nominals[],
                                                               std::size_t count);

// For co-simulation.
FMI2_EXPORT fmi2Status FMI2(fmi2SetRealInputDerivatives)(fmi2Component c,
                                                         const fmi2ValueReference references[],
                                                         std::size_t count,
                                                         const fmi2Integer orders[],
                                                         const fmi2Real values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2GetRealOutputDerivatives)(fmi2Component c,
                                                          const fmi2ValueReference references[],
                                                          std::size_t count,
                                                          const fmi2Integer orders[],
                                                          fmi2Real values[]);
FMI2_EXPORT fmi2Status FMI2(fmi2DoStep)(fmi2Component c, fmi2Real time, fmi2Real step,
                                        fmi2Boolean no_return);
FMI2_EXPORT fmi2Status FMI2(fmi2CancelStep)(fmi2Component c);
FMI2_EXPORT fmi2Status FMI2(fmi2GetStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Status* value);
FMI2_EXPORT fmi2Status FMI2(fmi2GetRealStatus)(fmi2Component c, fmi2StatusKind kind,
                                               fmi2Real* value);
FMI2_EXPORT fmi2Status FMI2(fmi2GetIntegerStatus)(fmi2Component c, fmi2StatusKind kind,
                                                  fmi2Integer* value);
FMI2_EXPORT fmi2Status FMI2(fmi2GetBooleanStatus)(fmi2Component c, fmi2StatusKind kind,
                                                  fmi2Boolean* value);
FMI2_EXPORT fmi2Status FMI2(fmi2GetStringStatus)(fmi2Component c, fmi2StatusKind kind,
                                                 fmi2String* value);

}  // extern "C"
