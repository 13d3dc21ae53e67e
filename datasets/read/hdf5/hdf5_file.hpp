#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace rigcal::datasets {

/// Returns the reason that HDF5 gives for its last failure: the outermost entry of its error stack.
inline std::string hdf5_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* text) -> herr_t {
        if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  return reason;
}

/// Owns an HDF5 identifier.
class Hdf5Id {
 public:
  Hdf5Id() = default;
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  explicit operator bool() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// A dataset or, if the dataset is a table, one of its members.
struct Hdf5Series {
  std::string path;     ///< "/run1/position"; "/run1/table.position" for a member
  std::string dataset;  ///< "/run1/table"
  std::string member;   ///< "position"; empty if the dataset is not a table
  /// Shape, in the order that h5dump and h5py print: the dimensions of the dataset, followed by
  /// those of its cells if they are arrays.
  std::vector<std::size_t> dims;
  std::size_t cell_dims = 0;       ///< number of `dims` that belong to the cells
  std::string kind;                ///< kind of the elements if not numbers: "text"; else empty
  std::vector<std::string> units;  ///< one for all, one per series, or none

  /// Cannot overflow: the dimensions were checked when they were read.
  std::size_t element_count() const;
};

/// Sample times with constant steps, described by an attribute: "/run1/position@wf_increment".
struct Hdf5Clock {
  std::string path;
  std::string series;  ///< series to which it applies; empty: the attribute belongs to a group
  double start_s = 0.0;
  double step_s = 0.0;  ///< 0 if `rate_hz` is given
  double rate_hz = 0.0;
};

/// Elements along one dimension of a series. The indices in the other dimensions are `fixed`.
struct Hdf5Line {
  std::size_t along = 0;
  std::vector<std::size_t> fixed;
};

/// Reads HDF5 files. A single damaged byte can crash the library or make it hang, so use this class
/// only within run_confined(), from one thread.
///
/// Follows only hard links, so that no other file is opened.
class Hdf5File {
 public:
  /// @throws InputError  if HDF5 cannot open the file, or if it has more than 200 000 objects
  explicit Hdf5File(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  const std::vector<Hdf5Series>& series() const { return series_; }
  const std::vector<Hdf5Clock>& clocks() const { return clocks_; }

  /// Returns the numbers of a series whose kind is empty, unpacked using the `scale_factor` and
  /// `add_offset` of its dataset.
  /// @throws InputError  if a number is damaged, was never written, is an integer that a double
  ///                     cannot represent, or is missing according to `_FillValue`, `missing_value`
  ///                     or the dataset's own fill value; or if the dataset was only partly
  ///                     written, is stored in another file, or is compressed by an unknown filter
  std::vector<double> numbers(const Hdf5Series& series, const Hdf5Line& line,
                              const std::string& column) const;

 private:
  [[noreturn]] void fail(const std::string& message) const;
  void list_group(hid_t group, const std::string& path, std::vector<haddr_t>& above);
  void list_dataset(hid_t dataset, const std::string& path);
  void list_clocks(hid_t object, const std::string& path, bool is_group);
  void require_readable(hid_t dataset, const std::string& column) const;
  void require_written(hid_t dataset, const Hdf5Series& series, const Hdf5Line& line,
                       const std::string& column) const;
  std::vector<double> unpacked(hid_t dataset, std::vector<double> values,
                               const std::string& column) const;

  std::string name_;
  Hdf5Id file_;
  std::size_t objects_ = 0;
  std::vector<Hdf5Series> series_;
  std::vector<Hdf5Clock> clocks_;
};

}  // namespace rigcal::datasets
