#pragma once

#include <filesystem>

namespace rigcal::datasets {

/// Refuses a MAT file that ends early or whose structure is damaged, before matio, which takes
/// such a file for a shorter one, reads it.
///
/// Version 5: the sizes of the variables must add up to the size of the file, and compressed
/// variables must inflate to their checksum. Version 7.3: HDF5 must be able to open it. Other
/// versions are refused.
///
/// @throws InputError
void require_intact_mat_file(const std::filesystem::path& path);

/// Keeps HDF5 from printing its errors; rigcal reports them itself.
class QuietHdf5 {
 public:
  QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;
  ~QuietHdf5();

 private:
  using Handler = int (*)(long, void*);  // H5E_auto2_t
  Handler handler_ = nullptr;
  void* data_ = nullptr;
};

}  // namespace rigcal::datasets
