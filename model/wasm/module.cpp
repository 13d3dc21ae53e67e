// The model as a WebAssembly module for pages that simulate (report/live). WebAssembly functions
// exchange only numbers, so every argument is a number or the address of an array of numbers. The
// module runs one simulation at a time.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <vector>

#include "model/simulate.hpp"

// Exports a function to the page.
#define RIGCAL_EXPORT(name) extern "C" __attribute__((export_name(#name)))

/// Implemented by the page, which receives the message of a failure. The module must not be used
/// afterwards.
extern "C" __attribute__((import_module("rigcal"), import_name("failed"))) void rigcal_failed(
    const char* message);

// WebAssembly from these compilers cannot unwind the stack. If the model throws because a caller
// broke its contract, the page receives the message and the module ends.
extern "C" void* __cxa_allocate_exception(std::size_t size) noexcept {
  return ::operator new(size);
}
extern "C" [[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  const bool has_message = *type == typeid(std::invalid_argument) ||
                           *type == typeid(std::logic_error) || *type == typeid(std::out_of_range);
  rigcal_failed(has_message ? static_cast<std::exception*>(thrown)->what() : type->name());
  __builtin_trap();
}

namespace {

using namespace rigcal::model;

/// The first seven numbers of an input are kind, number of samples, amplitude, frequency [Hz], end
/// frequency [Hz], sweep time [s], and 1 for a logarithmic sweep. Times and values of the samples
/// follow.
constexpr std::size_t kInputNumbers = 7;
enum class InputKind { constant, sine, square, chirp, held, linear };

Signal signal_of(const double* numbers) {
  const auto samples = static_cast<std::size_t>(numbers[1]);
  const double amplitude = numbers[2];
  const double frequency_hz = numbers[3];
  const auto column = [&](std::size_t index) {
    const double* begin = numbers + kInputNumbers + index * samples;
    return std::vector<double>(begin, begin + samples);
  };
  switch (static_cast<InputKind>(numbers[0])) {
    case InputKind::constant:
      return Signal::constant(amplitude);
    case InputKind::sine:
      return Signal::sine(amplitude, frequency_hz);
    case InputKind::square:
      return Signal::square(amplitude, frequency_hz);
    case InputKind::chirp:
      return Signal::chirp(amplitude, frequency_hz, numbers[4], numbers[5], numbers[6] != 0.0);
    case InputKind::held:
      return Signal::held(column(0), column(1));
    case InputKind::linear:
      return Signal::linear(column(0), column(1));
  }
  throw std::invalid_argument("no such input");
}

std::optional<Signal> optional_signal_of(const double* numbers) {
  return numbers == nullptr ? std::nullopt : std::optional(signal_of(numbers));
}

Simulation last_run;

}  // namespace

/// Allocates memory for `count` doubles.
RIGCAL_EXPORT(allocate) double* allocate(std::size_t count) { return new double[count]; }
RIGCAL_EXPORT(release) void release(const double* numbers) { delete[] numbers; }

RIGCAL_EXPORT(parameter_count) int parameter_count(int plant) {
  return static_cast<int>(parameter_table(static_cast<PlantKind>(plant)).size());
}
RIGCAL_EXPORT(output_count) int output_count() { return static_cast<int>(kAllOutputs.size()); }

/// Simulates without sensitivities.
///
/// @param rig      enumerators of plant, controller, initial state and method; tolerance; time
///                 limit [s]; enumerators of the controlled quantity and of Before; time of the
///                 drive's first sample [s]
/// @param values   shape (2, parameters): SI values, and 1 for each that is given
/// @param drive    an input in the format of kInputNumbers. `load`, `supply`, `tank`, `base`
///                 (its acceleration) and `temperature` (of the oil) have the same format; null if
///                 absent.
/// @param outputs  shape (samples, outputs), column by column, SI; written only if the result is ok
/// @return         SimulationStatus; 0 is ok
RIGCAL_EXPORT(simulate)
int simulate_rig(const double* rig, const double* values, const double* drive, const double* load,
                 const double* supply, const double* tank, const double* base,
                 const double* temperature, const double* times_s, int samples, double* outputs) {
  const Rig kind{static_cast<PlantKind>(rig[0]), static_cast<ControllerKind>(rig[1]),
                 static_cast<InitialState>(rig[2]), static_cast<Feedback>(rig[6]),
                 static_cast<Before>(rig[7])};
  SimulationOptions options;
  options.method = static_cast<Method>(rig[3]);
  options.tolerance = rig[4];
  options.max_seconds = rig[5];
  ParameterValues parameters = ParameterValues::defaults(kind.plant);
  const std::size_t count = parameters.value.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (values[count + i] != 0.0) parameters.set(static_cast<int>(i), values[i]);
  }
  const SimulationInputs inputs{signal_of(drive),
                                optional_signal_of(load),
                                optional_signal_of(supply),
                                optional_signal_of(tank),
                                rig[8],
                                std::nullopt,
                                optional_signal_of(base),
                                optional_signal_of(temperature)};
  last_run =
      rigcal::model::simulate(kind, parameters, {}, inputs,
                              {times_s, static_cast<std::size_t>(samples)}, kAllOutputs, options);
  if (last_run.ok()) std::copy_n(last_run.outputs.data(), last_run.outputs.size(), outputs);
  return static_cast<int>(last_run.status);
}

// Details of the last simulation.
RIGCAL_EXPORT(reason) const char* reason() { return last_run.reason.c_str(); }
RIGCAL_EXPORT(failed_at_s) double failed_at_s() { return last_run.failed_at_s; }
RIGCAL_EXPORT(steps) int steps() {
  return static_cast<int>(last_run.steps + last_run.rejected_steps);
}
