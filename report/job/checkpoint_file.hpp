#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "calib/fit.hpp"
#include "calib/search/checkpoint.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// File in the result folder from which a fit can continue after a kill.
class CheckpointFile {
 public:
  /// @param provenance  of the fit; borrowed
  CheckpointFile(const std::filesystem::path& out, const Provenance& provenance);

  /// The checkpoint of an earlier run of the same fit; empty where there is none.
  ///
  /// @throws InputError  it is one of another fit, or none at all
  std::optional<calib::Checkpoint> read() const;

  /// Writes a checkpoint unless that would take more than a twentieth of the time.
  void keep(const calib::Checkpoint& checkpoint);

  /// Writes the withheld state if the fit was stopped; else removes the file.
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
