#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "calib/fit.hpp"
#include "calib/search/checkpoint.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// A file in the result folder from which a fit can resume after it was killed.
class CheckpointFile {
 public:
  /// @param provenance  provenance of the fit; borrowed
  CheckpointFile(const std::filesystem::path& out, const Provenance& provenance);

  /// Reads the checkpoint that an earlier run of the same fit left; std::nullopt if there is none.
  ///
  /// @throws InputError  if the file belongs to another fit or is not a checkpoint
  std::optional<calib::Checkpoint> read() const;

  /// Writes a checkpoint, or postpones it if writing would take more than a twentieth of the time.
  void keep(const calib::Checkpoint& checkpoint);

  /// If the fit was stopped, writes the postponed checkpoint; otherwise removes the file.
  void finish(calib::FitStatus status);

 private:
  using Clock = std::chrono::steady_clock;

  void write();

  std::filesystem::path file_;
  const Provenance& provenance_;
  std::optional<calib::Checkpoint> unwritten_;
  Clock::time_point not_before_{};
};

}  // namespace rigcal::report
