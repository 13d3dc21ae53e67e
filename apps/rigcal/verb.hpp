#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <string>

#include "common/error.hpp"
#include "common/task_farm.hpp"

namespace rigcal::app {

/// Data of this run of the command for every verb.
struct Invocation {
  std::string command;              ///< the command line
  const std::atomic<bool>& cancel;  ///< becomes true when a signal asks the run to end
  TaskFarm* processes = nullptr;    ///< processes that were started together; null: only this one

  /// Among cooperating processes only the first one writes and prints.
  bool leads() const { return processes == nullptr || processes->rank() == 0; }
};

using Run = std::function<ExitCode(const Invocation&)>;

// Each adds the options of one verb to its subcommand and returns the function that runs it.
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
