#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/parallel.hpp"

namespace rigcal {

/// Independent tasks whose results are bytes.
struct FarmJob {
  std::string name;       ///< such as "profiles"; the same job runs at most once
  std::string state;      ///< serialised inputs of the tasks, which determine the results
  std::size_t count = 0;  ///< number of tasks
  int lanes = 1;          ///< number of tasks that run at a time in each process
  std::map<std::size_t, std::string> known = {};  ///< results that exist already
};

/// Thrown if the first process has ended without this job.
class FarmEnded : public std::runtime_error {
 public:
  FarmEnded() : std::runtime_error("the first process has ended without this job") {}
};

/// Result of a task.
struct TaskResult {
  std::string bytes;
  bool whole = true;  ///< false: a limit or a signal cut the task short, or it did not start
};

/// Runs jobs, in the threads of this process and possibly in other processes, too. Each task must
/// depend only on its number and on the job's state, so that it can run anywhere, and more than
/// once.
class TaskFarm {
 public:
  using Task = std::function<TaskResult(std::size_t)>;
  /// Called with each result as soon as it is available, in any order and from any thread, possibly
  /// concurrently. If several processes cooperate, it is called only in the first one.
  using Done = std::function<void(std::size_t, const TaskResult&)>;

  TaskFarm() = default;
  TaskFarm(const TaskFarm&) = delete;
  TaskFarm& operator=(const TaskFarm&) = delete;
  virtual ~TaskFarm() = default;

  /// Returns the results of tasks 0 to count - 1, in order, in every process that runs the job.
  ///
  /// @throws  the exception of the task with the lowest index, or FarmEnded
  virtual std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) = 0;

  /// Number of this process, counted from 0, and the total number of processes.
  virtual int rank() const { return 0; }
  virtual int processes() const { return 1; }
};

/// Runs tasks in the threads of this process.
class ThreadFarm final : public TaskFarm {
 public:
  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override {
    std::vector<TaskResult> results(job.count);
    parallel_for(job.count, job.lanes, [&](std::size_t i) {
      const auto known = job.known.find(i);
      results[i] = known != job.known.end() ? TaskResult{known->second, true} : task(i);
      if (done) done(i, results[i]);
    });
    return results;
  }
};

}  // namespace rigcal
