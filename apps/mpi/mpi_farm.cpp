#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "common/bytes.hpp"
#include "common/task_farm.hpp"

// `rigcal` loads this library if mpirun or srun started it (apps/rigcal/processes.cpp), so that the
// program itself does not depend on MPI.
//
// Every process runs the same program on the same inputs and reaches the same jobs. The first
// process leads: it hands out tasks, collects the results and sends all of them to every process
// that asks. Processes wait for each other only within a job and at the end; for a late process the
// results are already available. Only main threads call MPI.

namespace rigcal {
namespace {

/// Pause between two polls by an idle process. Waiting inside MPI would occupy a whole processor.
constexpr auto kPause = std::chrono::microseconds(300);
constexpr int kTag = 1;

enum class Kind : std::uint8_t {
  request,  ///< to the leader: a lane is free
  result,   ///< to the leader: result of a task
  bye,      ///< to the leader: last message
  assign,   ///< from the leader: run this task
  all,      ///< from the leader: every result of the job
  gone,     ///< from the leader: the job no longer exists
};

struct Slot {
  TaskResult result;
  bool threw = false;
  bool there = false;
};

template <typename Archive>
void serialize(Archive& archive, Slot& slot) {
  archive(slot.result.bytes, slot.result.whole, slot.threw, slot.there);
}

struct Message {
  int other = 0;  ///< rank of the receiver or sender
  Kind kind = Kind::request;
  std::string job;
  std::uint64_t index = 0;
  std::vector<Slot> slots;
};

void send(const Message& message) {
  const std::string bytes = to_bytes(message.kind, message.job, message.index, message.slots);
  if (bytes.size() > static_cast<std::size_t>(INT_MAX))
    throw std::runtime_error(
        "results of more than 2 GB cannot be sent from one process to another");
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, message.other, kTag,
           MPI_COMM_WORLD);
}

std::optional<Message> receive() {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return std::nullopt;
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, kTag, MPI_COMM_WORLD, &status);
  Message message;
  from_bytes(bytes, message.kind, message.job, message.index, message.slots);
  message.other = status.MPI_SOURCE;
  return message;
}

Slot make(const TaskFarm::Task& task, std::size_t index) {
  Slot slot;
  slot.there = true;
  try {
    slot.result = task(index);
  } catch (...) {
    slot.threw = true;  // a process that needs the results runs the task again and throws there
  }
  return slot;
}

/// Passes tasks to the threads of this process and collects their results.
class Lanes {
 public:
  Lanes(int count, const TaskFarm::Task& task) : idle_(count) {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this, &task] { work(task); });
  }
  Lanes(const Lanes&) = delete;
  Lanes& operator=(const Lanes&) = delete;
  ~Lanes() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

  int idle() {
    const std::lock_guard lock(mutex_);
    return idle_;
  }
  void give(std::size_t index) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(index);
      --idle_;
    }
    changed_.notify_one();
  }
  std::vector<std::pair<std::size_t, Slot>> take_made() {
    const std::lock_guard lock(mutex_);
    return std::exchange(made_, {});
  }

 private:
  void work(const TaskFarm::Task& task) {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      const std::size_t index = tasks_.front();
      tasks_.pop_front();
      lock.unlock();
      Slot slot = make(task, index);
      lock.lock();
      made_.emplace_back(index, std::move(slot));
      ++idle_;
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> tasks_;
  std::vector<std::pair<std::size_t, Slot>> made_;
  int idle_;
  bool ended_ = false;
  std::vector<std::jthread> threads_;  // last, so that the threads end before the members they use
                                       // are destroyed
};

class MpiFarm final : public TaskFarm {
 public:
  MpiFarm() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &processes_);
  }
  ~MpiFarm() override {
    if (rank_ == 0) {
      for (const Message& message : std::exchange(early_, {})) serve(message, nullptr);
      while (gone_ < processes_ - 1) look(nullptr);
      for (int other = 1; other < processes_; ++other) send({other, Kind::gone, "", 0, {}});
    } else {
      send({0, Kind::bye, "", 0, {}});
      while (!receive()) std::this_thread::sleep_for(kPause);
    }
    MPI_Finalize();
  }
  MpiFarm(const MpiFarm&) = delete;
  MpiFarm& operator=(const MpiFarm&) = delete;

  int rank() const override { return rank_; }
  int processes() const override { return processes_; }

  std::vector<TaskResult> run(const FarmJob& job, const Task& task, const Done& done) override {
    const std::vector<Slot> slots = rank_ == 0 ? lead(job, task, done) : follow(job, task);
    std::vector<TaskResult> results;
    for (std::size_t i = 0; i < slots.size(); ++i)
      results.push_back(slots[i].threw ? task(i) : slots[i].result);
    return results;
  }

 private:
  /// A job that the leader is running.
  struct Led {
    std::string name;
    std::vector<Slot> slots;
    std::size_t next = 0;        ///< the first task that has not been started
    std::size_t missing = 0;     ///< number of results that have not arrived
    std::vector<int> waiting{};  ///< processes waiting for a task
    const Done* done = nullptr;
    const FarmJob* job = nullptr;

    std::optional<std::size_t> take() {
      while (next < slots.size() && slots[next].there) ++next;
      return next < slots.size() ? std::optional(next++) : std::nullopt;
    }
    void put(std::size_t index, Slot slot) {
      slots.at(index) = std::move(slot);
      --missing;
      if (*done && !slots[index].threw) (*done)(index, slots[index].result);
    }
  };

  static std::string name_of(const FarmJob& job) {
    return to_bytes(job.name, job.state, static_cast<std::uint64_t>(job.count));
  }

  std::vector<Slot> lead(const FarmJob& job, const Task& task, const Done& done) {
    Led led{name_of(job), std::vector<Slot>(job.count), 0, job.count, {}, &done, &job};
    for (const auto& [index, bytes] : job.known) {
      if (index < job.count && !led.slots[index].there)
        led.put(index, {{bytes, true}, false, true});
    }
    for (const Message& message : std::exchange(early_, {})) serve(message, &led);
    {
      Lanes lanes(job.lanes, task);
      while (led.missing > 0) {
        for (int idle = lanes.idle(); idle > 0; --idle) {
          const auto index = led.take();
          if (!index) break;
          lanes.give(*index);
        }
        for (auto& [index, slot] : lanes.take_made()) led.put(index, std::move(slot));
        look(&led);
      }
    }
    for (const int other : led.waiting) send({other, Kind::all, led.name, 0, led.slots});
    finished_[led.name] = led.slots;
    return led.slots;
  }

  /// Handles one message, or sleeps if there is none.
  void look(Led* led) {
    const auto message = receive();
    if (message) {
      serve(*message, led);
    } else {
      std::this_thread::sleep_for(kPause);
    }
  }

  void serve(const Message& message, Led* led) {
    if (message.kind == Kind::bye) {
      ++gone_;
      return;
    }
    const auto finished = finished_.find(message.job);
    const bool current = led != nullptr && led->name == message.job;
    if (message.kind == Kind::result) {
      if (current) led->put(message.index, message.slots.at(0));
    } else if (finished != finished_.end()) {
      send({message.other, Kind::all, message.job, 0, finished->second});
    } else if (current) {
      const auto index = led->take();
      if (index) {
        send({message.other, Kind::assign, message.job, *index, {}});
      } else {
        led->waiting.push_back(message.other);
      }
    } else if (led != nullptr) {
      early_.push_back(message);  // belongs to a job that this process has not reached
    } else {
      send({message.other, Kind::gone, message.job, 0, {}});
    }
  }

  static std::vector<Slot> follow(const FarmJob& job, const Task& task) {
    const std::string name = name_of(job);
    Lanes lanes(job.lanes, task);
    bool asked = false;
    for (;;) {
      for (auto& [index, slot] : lanes.take_made())
        send({0, Kind::result, name, index, {std::move(slot)}});
      if (!asked && lanes.idle() > 0) {
        send({0, Kind::request, name, 0, {}});
        asked = true;
      }
      const auto message = receive();
      if (!message) {
        std::this_thread::sleep_for(kPause);
      } else if (message->kind == Kind::assign) {
        lanes.give(message->index);
        asked = false;
      } else if (message->kind == Kind::all) {
        return message->slots;
      } else {
        throw FarmEnded();
      }
    }
  }

  int rank_ = 0;
  int processes_ = 1;
  int gone_ = 0;                                         ///< processes that sent their last message
  std::map<std::string, std::vector<Slot>> finished_{};  ///< results of finished jobs, on the
                                                         ///< leader
  std::vector<Message> early_{};                         ///< messages to the leader that arrived
                                                         ///< before it reached the job
};

}  // namespace
}  // namespace rigcal

/// The caller owns the farm and must destroy it before the process ends.
extern "C" rigcal::TaskFarm* rigcal_mpi_farm() {
  return new rigcal::MpiFarm;  // NOLINT(cppcoreguidelines-owning-memory): this is a C interface
}
