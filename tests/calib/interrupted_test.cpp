#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <thread>

#include "calib/fit.hpp"
#include "common/task_farm.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

/// Runs tasks in this thread, and records the results that each would leave for a later run.
class NotingFarm final : public TaskFarm {
 public:
  /// Results of complete tasks, by job, state and index.
  std::map<std::string, std::string> kept;

  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override {
    return threads_.run(job, task, [&](std::size_t i, const TaskResult& result) {
      if (result.whole) kept[job.name + '/' + job.state + '/' + std::to_string(i)] = result.bytes;
      if (done) done(i, result);
    });
  }

 private:
  ThreadFarm threads_;
};

/// One short condition that is quick to fit.
Twin quick_twin() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  twin.add("sine", datasets::Waveform::sine, 2.0, 0.01);
  return twin;
}

}  // namespace

TEST_CASE("fit: a task that a signal cuts short leaves nothing to a later run", "[calib]") {
  const Twin twin = quick_twin();
  const auto records = twin.records(150, 500.0, 3);
  FitOptions options;
  const bool posterior = GENERATE(false, true);
  if (posterior) {
    options.posterior = 2;
  } else {
    options.bootstrap = 40;
    options.profiles = true;
    options.cross_validate = true;
  }
  NotingFarm whole;
  options.farm = &whole;
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(fit(twin.campaign, records, options).usable());
  const auto took = std::chrono::steady_clock::now() - begin;
  REQUIRE(whole.kept.size() >= (posterior ? 8 : 40));

  // The signal comes at times that are spread evenly over the job, hence mostly within a
  // simulation.
  const int signals = posterior ? 12 : 40;
  for (int k = 1; k < signals; ++k) {
    CAPTURE(k);
    NotingFarm cut;
    std::atomic<bool> cancel{false};
    options.farm = &cut;
    options.cancel = &cancel;
    auto signal = std::async(std::launch::async, [&] {
      std::this_thread::sleep_for(took * k / signals);
      cancel = true;
    });
    fit(twin.campaign, records, options);
    signal.get();
    for (const auto& [task, bytes] : cut.kept) {
      const auto same = whole.kept.find(task);
      CAPTURE(task.substr(0, task.find('/')));
      // A job with another state belongs to another optimum, which a later run does not ask for.
      if (same != whole.kept.end()) CHECK((same->second == bytes));
    }
  }
}

}  // namespace rigcal::calib
