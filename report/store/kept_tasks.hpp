#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "common/task_farm.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// File in which a fit keeps the results of bootstrap replicates, profiles and cross-validation
/// folds, and of starts if these run in several processes.
inline constexpr const char* kKeptTasksFile = "checkpoint.tasks";

/// Whether a file contains kept tasks, complete or truncated.
bool is_kept_tasks(const std::filesystem::path& file);

/// A task farm that writes each result to a file immediately, so that a killed run loses only its
/// unfinished tasks. Each entry contains a hash; an incomplete entry and everything after it are
/// ignored. A result is identified by the hash of its inputs (files, options, seed, version, and
/// the state of its job), so that results from another fit are not used.
class KeptTasks final : public TaskFarm {
 public:
  /// @param farm        runs the tasks; borrowed
  /// @param provenance  provenance of the fit
  /// @param resume      whether to use results in the file; otherwise the file is removed
  /// @throws InputError  if the file cannot be read
  KeptTasks(TaskFarm& farm, std::filesystem::path file, const Provenance& provenance, bool resume);

  /// @throws WriteError  if a result cannot be written
  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override;
  int rank() const override { return farm_.rank(); }
  int processes() const override { return farm_.processes(); }

  /// Returns the number of results found from an earlier run.
  std::size_t found() const { return found_; }
  /// Removes the file; to be called once the results of the fit are written.
  void remove();

 private:
  void read();
  void keep(const std::string& job, std::size_t index, const std::string& bytes);

  TaskFarm& farm_;
  std::filesystem::path file_;
  std::string of_;  ///< hash of the provenance
  std::map<std::string, std::map<std::size_t, std::string>> known_;
  std::size_t found_ = 0;
  std::mutex mutex_;
};

}  // namespace rigcal::report
