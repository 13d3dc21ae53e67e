#include "report/store/kept_tasks.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "common/bytes.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/folder.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

/// Returns a hash that identifies one job in one fit.
std::string name_of(const std::string& fit, const FarmJob& job) {
  return sha256_of_text(to_bytes(fit, job.name, job.state, job.count));
}

/// Makes an entry: length and hash of the content, then the content.
std::string entry_of(const std::string& job, std::size_t index, const std::string& bytes) {
  const std::string content = to_bytes(job, static_cast<std::uint64_t>(index), bytes);
  return fmt::format("{:016x}{}", content.size(), sha256_of_text(content)) + content;
}

// Numbers of hexadecimal digits for length and hash at the beginning of an entry.
constexpr std::size_t kLength = 16;
constexpr std::size_t kHash = 64;

/// Removes the next complete entry from the front and returns its content; empty if there is none.
std::string_view take_entry(std::string_view& rest) {
  if (rest.size() < kLength + kHash) return {};
  std::size_t length = 0;
  for (const char c : rest.substr(0, kLength)) {
    const std::size_t digit = std::string_view("0123456789abcdef").find(c);
    if (digit == std::string_view::npos || length > kMostBytes) return {};
    length = 16 * length + digit;
  }
  const std::string_view hash = rest.substr(kLength, kHash);
  const std::string_view after = rest.substr(kLength + kHash);
  if (after.size() < length || sha256_of_text(after.substr(0, length)) != hash) return {};
  rest = after.substr(length);
  return after.substr(0, length);
}

}  // namespace

bool is_kept_tasks(const std::filesystem::path& file) {
  std::string head(kLength + kHash, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find_first_not_of("0123456789abcdef") == std::string::npos;
}

KeptTasks::KeptTasks(TaskFarm& farm, std::filesystem::path file, const Provenance& provenance,
                     bool resume)
    : farm_(farm), file_(std::move(file)), of_(fit_identity(provenance)) {
  if (resume) {
    read();
  } else {
    remove();
  }
}

void KeptTasks::read() {
  if (!std::filesystem::exists(file_)) return;
  const std::string text = read_file(file_, kMostBytes, "results of tasks that a fit has kept");
  std::string_view rest = text;
  for (std::string_view entry = take_entry(rest); !entry.empty(); entry = take_entry(rest)) {
    std::string job;
    std::uint64_t index = 0;
    std::string bytes;
    from_bytes(std::string(entry), job, index, bytes);
    known_[job][index] = std::move(bytes);
    ++found_;
  }
  std::error_code failed;
  std::filesystem::resize_file(file_, text.size() - rest.size(), failed);
  if (failed)
    throw WriteError(
        fmt::format("{}: it cannot be truncated: {}", file_.string(), failed.message()));
}

void KeptTasks::keep(const std::string& job, std::size_t index, const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  std::ofstream file(file_, std::ios::binary | std::ios::app);
  file << entry_of(job, index, bytes) << std::flush;
  if (!file) throw WriteError(fmt::format("{}: it cannot be written", file_.string()));
}

std::vector<TaskResult> KeptTasks::run(const FarmJob& job, const Task& task, const Done& done) {
  const std::string name = name_of(of_, job);
  FarmJob all = job;
  all.known = known_[name];
  return farm_.run(all, task, [&](std::size_t i, const TaskResult& result) {
    if (result.whole && !all.known.contains(i)) keep(name, i, result.bytes);
    if (done) done(i, result);
  });
}

void KeptTasks::remove() { remove_stale(file_); }

}  // namespace rigcal::report
