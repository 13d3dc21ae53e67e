#include "report/job/checkpoint_file.hpp"

#include "common/file.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/folder.hpp"

namespace rigcal::report {

CheckpointFile::CheckpointFile(const std::filesystem::path& out, const Provenance& provenance)
    : file_(out / kCheckpointFile), provenance_(provenance) {}

std::optional<calib::Checkpoint> CheckpointFile::read() const {
  if (!std::filesystem::exists(file_)) return std::nullopt;
  return read_checkpoint(file_, provenance_);
}

void CheckpointFile::keep(const calib::Checkpoint& checkpoint) {
  unwritten_ = checkpoint;
  if (Clock::now() >= not_before_) write();
}

void CheckpointFile::finish(calib::FitStatus status) {
  if (status != calib::FitStatus::stopped) {
    remove_stale(file_);
  } else if (unwritten_) {
    write();
  }
}

void CheckpointFile::write() {
  constexpr int kShare = 20;  // time for fitting relative to time for writing
  const auto began = Clock::now();
  write_file_atomically(file_, checkpoint_text(*unwritten_, provenance_));
  const auto ended = Clock::now();
  not_before_ = ended + kShare * (ended - began);
  unwritten_.reset();
}

}  // namespace rigcal::report
