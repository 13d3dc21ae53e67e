#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <string>

#include "common/error.hpp"
#include "common/task_farm.hpp"

namespace rigcal::app {

/// What every verb needs to know about this run of the command.
struct Invocation {
  std::string command;              ///< the command line
  const std::atomic<bool>& cancel;  ///< becomes true when a signal asks the run to stop
  TaskFarm* processes = nullptr;    ///< processes started together; null if there is only this one

  /// Returns true if this process writes and prints. Among cooperating processes only the first one
  /// does.
  bool leads() const { return processes == nullptr || processes->rank() == 0; }
};

using Run = std::function<ExitCode(const Invocation&)>;

// Each function adds the options of one verb to its subcommand and returns the function that runs
// the verb.
Run add_check(CLI::App& verb);
Run add_average(CLI::App& verb);
Run add_simulate(CLI::App& verb);
Run add_fit(CLI::App& verb);
Run add_validate(CLI::App& verb);
Run add_leak_table(CLI::App& verb);
Run add_fit_tables(CLI::App& verb);
Run add_diagnose(CLI::App& verb);
Run add_parity(CLI::App& verb);
Run add_plan(CLI::App& verb);
Run add_synthesize(CLI::App& verb);
Run add_init(CLI::App& verb);
Run add_batch(CLI::App& verb);
Run add_compare(CLI::App& verb);
Run add_report(CLI::App& verb);
Run add_params(CLI::App& verb);
Run add_schema(CLI::App& verb);
Run add_export(CLI::App& verb);
Run add_explore(CLI::App& verb);

}  // namespace rigcal::app
