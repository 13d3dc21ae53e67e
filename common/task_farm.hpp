#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/parallel.hpp"

namespace rigcal {

/// Runs equal pieces of work whose results are bytes: in the threads of this process, or in other
/// processes too. Each task must depend on its number alone, so that it may run anywhere, and more
/// than once.
class TaskFarm {
 public:
  /// Makes the result of one task.
  using Task = std::function<std::string(std::size_t)>;
  /// Told of each result as soon as it is there, in any order and from any thread, one at a time
  /// or not.
  using Done = std::function<void(std::size_t, const std::string&)>;

  TaskFarm() = default;
  TaskFarm(const TaskFarm&) = delete;
  TaskFarm& operator=(const TaskFarm&) = delete;
  virtual ~TaskFarm() = default;

  /// Results of tasks 0 to count - 1, in their order.
  ///
  /// @param lanes  tasks at a time in each process
  /// @throws  what a task threw
  virtual std::vector<std::string> run(std::size_t count, int lanes, const Task& task,
                                       const Done& done) = 0;
};

/// In the threads of this process.
class ThreadFarm final : public TaskFarm {
 public:
  std::vector<std::string> run(std::size_t count, int lanes, const Task& task,
                               const Done& done) override {
    std::vector<std::string> results(count);
    parallel_for(count, lanes, [&](std::size_t i) {
      results[i] = task(i);
      if (done) done(i, results[i]);
    });
    return results;
  }
};

}  // namespace rigcal
