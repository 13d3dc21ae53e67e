#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "datasets/read/mat/mat_array.hpp"

namespace rigcal::datasets {

/// Reads MAT files of version 7.3, which are HDF5 files, using matio. A single damaged byte can
/// crash either library or make it hang, so use this class only within run_confined(), and from
/// only one thread of a process.
class Hdf5Source : public MatSource {
 public:
  /// @throws InputError  if HDF5 cannot open the file
  explicit Hdf5Source(const std::filesystem::path& path);
  ~Hdf5Source() override;

  const std::string& name() const override;
  const std::vector<MatArray>& variables() const override;
  std::vector<double> numbers(const MatArray& array, const MatSelection& selection,
                              const std::string& column) override;

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace rigcal::datasets
