#include "apps/rigcal/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "apps/rigcal/options.hpp"
#include "calib/descent/descent.hpp"
#include "common/printable.hpp"

namespace rigcal::app {
namespace {

std::string left_text(const std::optional<double>& seconds) {
  return seconds ? fmt::format(", about {} left", report::duration_text(*seconds)) : std::string();
}

/// Describes an iteration. A step is rejected if its trial point is worse or could not be
/// simulated.
std::string step_text(int iteration, double cost, double relative_change) {
  constexpr double kNoCost = 1e300;  // Ceres reports the largest double if there is no cost
  if (!(cost < kNoCost)) return "trial could not be simulated";
  const std::string text = fmt::format("cost {:.6g}", cost);
  if (iteration == 0 || !std::isfinite(relative_change)) return text;
  return relative_change < 0.0 ? text + ", step rejected"
                               : fmt::format("{}, change {:.1e}", text, relative_change);
}

}  // namespace

StatusLine::StatusLine(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  if (is_open_) std::fputs("\n", stderr);
}

void StatusLine::show(const std::function<std::string(double)>& text) {
  if (quiet_) return;
  const auto now = Clock::now();
  const auto pause = std::chrono::milliseconds(is_open_ ? 100 : 1000);
  if (now - last_shown_ < pause) return;
  last_shown_ = now;
  std::string line = printable(text(std::chrono::duration<double>(now - begin_).count()));
  if (terminal_) {
    // A line that wraps could not be overwritten.
    const std::size_t columns = terminal_columns(STDERR_FILENO);
    if (columns > 0 && line.size() >= columns) line.resize(columns - 1);
    std::fputs(fmt::format("\r\x1b[K{}", line).c_str(), stderr);
    is_open_ = true;
  } else {
    say(line + "\n");
  }
  std::fflush(stderr);
}

FitProgress::FitProgress(bool quiet, std::string work, const calib::FitOptions& settings)
    : line_(quiet),
      work_(std::move(work)),
      left_(settings.starts, calib::kFunctionTolerance),
      max_seconds_(settings.max_seconds) {}

void FitProgress::operator()(int start, int iteration, double cost, double relative_change,
                             double /*seconds*/) {
  const std::lock_guard lock(mutex_);
  left_.note(start, relative_change);
  line_.show([&](double elapsed_s) {
    std::optional<double> left_s = left_.seconds(elapsed_s);
    if (max_seconds_) {
      const double limit_s = std::max(0.0, *max_seconds_ - elapsed_s);
      left_s = std::min(left_s.value_or(limit_s), limit_s);
    }
    return fmt::format("{}, iteration {}: {}, {}{}", fmt::format(fmt::runtime(work_), start),
                       iteration, step_text(iteration, cost, relative_change),
                       report::duration_text(elapsed_s), left_text(left_s));
  });
}

void BesideProgress::operator()(const char* pieces, int done, int all) {
  const std::lock_guard lock(mutex_);
  if (!line_ || pieces_ != pieces) {
    pieces_ = pieces;
    line_.emplace(quiet_, pieces_);
  }
  (*line_)(done, all);
}

CountProgress::CountProgress(bool quiet, std::string pieces)
    : line_(quiet), pieces_(std::move(pieces)) {}

void CountProgress::operator()(int done, int all) {
  const std::lock_guard lock(mutex_);
  line_.show([&](double elapsed_s) {
    std::optional<double> left_s;
    if (done > 0) left_s = elapsed_s * (all - done) / done;
    return fmt::format("{} of {} {}, {}{}", done, all, pieces_, report::duration_text(elapsed_s),
                       left_text(left_s));
  });
}

}  // namespace rigcal::app
