#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace rigcal::test {

/// Writes an HDF5 file piece by piece. Creates missing groups.
class Hdf5Writer {
 public:
  /// @param user_block  bytes before the file's own, such as the header of a MAT file: 512 or a
  ///                    larger power of two; 0: none
  explicit Hdf5Writer(const std::filesystem::path& path, hsize_t user_block = 0) {
    std::filesystem::create_directories(path.parent_path());
    const hid_t plan = checked(H5Pcreate(H5P_FILE_CREATE));
    H5Pset_userblock(plan, user_block);
    file_ = checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, plan, H5P_DEFAULT));
    H5Pclose(plan);
    links_ = checked(H5Pcreate(H5P_LINK_CREATE));
    H5Pset_create_intermediate_group(links_, 1);
  }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;
  ~Hdf5Writer() {
    H5Pclose(links_);
    H5Fclose(file_);
  }

  hid_t file() const { return file_; }

  /// Writes an array of doubles, stored as `type`; a vector if no shape is given.
  /// @param packed  whether to store it in chunks compressed with gzip
  void array(const std::string& path, const std::vector<double>& values,
             std::vector<hsize_t> shape = {}, hid_t type = H5T_IEEE_F64LE,
             bool packed = false) const {
    if (shape.empty()) shape = {values.size()};
    const hid_t plan = checked(H5Pcreate(H5P_DATASET_CREATE));
    if (packed) {
      const std::vector<hsize_t> chunk(shape.size(), 2);
      H5Pset_chunk(plan, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(plan);
      H5Pset_deflate(plan, 6);
    }
    const hid_t set = dataset(path, shape, type, plan);
    checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    H5Dclose(set);
    H5Pclose(plan);
  }

  /// Writes 64-bit integers, including those that a double cannot represent.
  void integers(const std::string& path, const std::vector<long long>& values,
                hid_t type = H5T_STD_I64LE) const {
    const hid_t set = dataset(path, {values.size()}, type, H5P_DEFAULT);
    checked(H5Dwrite(set, H5T_NATIVE_LLONG, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    H5Dclose(set);
  }

  /// Writes a table: a column of doubles per member, stored as `type`.
  void table(const std::string& path,
             const std::vector<std::pair<std::string, std::vector<double>>>& columns,
             hid_t type = H5T_IEEE_F32BE) const {
    const std::size_t rows = columns.front().second.size();
    const hid_t stored = checked(H5Tcreate(H5T_COMPOUND, columns.size() * H5Tget_size(type)));
    const hid_t memory = checked(H5Tcreate(H5T_COMPOUND, columns.size() * sizeof(double)));
    std::vector<double> values(rows * columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      H5Tinsert(stored, columns[k].first.c_str(), k * H5Tget_size(type), type);
      H5Tinsert(memory, columns[k].first.c_str(), k * sizeof(double), H5T_NATIVE_DOUBLE);
      for (std::size_t i = 0; i < rows; ++i)
        values[i * columns.size() + k] = columns[k].second.at(i);
    }
    const hid_t set = dataset(path, {rows}, stored, H5P_DEFAULT);
    checked(H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    H5Dclose(set);
    H5Tclose(stored);
    H5Tclose(memory);
  }

  /// Writes a chunked vector of `rows` doubles, of which only the first are written.
  /// @param fill  value that HDF5 returns for the others; null: its default of zero
  void partly_written(const std::string& path, const std::vector<double>& values, hsize_t rows,
                      hsize_t chunk, const double* fill = nullptr) const {
    const hid_t plan = checked(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_chunk(plan, 1, &chunk);
    H5Pset_deflate(plan, 6);
    if (fill != nullptr) H5Pset_fill_value(plan, H5T_NATIVE_DOUBLE, fill);
    const hid_t set = dataset(path, {rows}, H5T_IEEE_F64LE, plan);
    const hid_t space = checked(H5Dget_space(set));
    const hsize_t start = 0;
    const auto count = static_cast<hsize_t>(values.size());
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count, nullptr);
    const hid_t memory = checked(H5Screate_simple(1, &count, nullptr));
    checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()));
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(set);
    H5Pclose(plan);
  }

  /// Creates a matrix of doubles in which each column is a chunk, and writes only the first column.
  void first_column(const std::string& path, const std::vector<double>& values,
                    hsize_t columns) const {
    const std::vector<hsize_t> column{values.size(), 1};
    const std::vector<hsize_t> start{0, 0};
    const hid_t plan = checked(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_chunk(plan, 2, column.data());
    const hid_t set = dataset(path, {values.size(), columns}, H5T_IEEE_F64LE, plan);
    const hid_t space = checked(H5Dget_space(set));
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, column.data(), nullptr);
    const hid_t memory = checked(H5Screate_simple(2, column.data(), nullptr));
    checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()));
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(set);
    H5Pclose(plan);
  }

  /// Creates a dataset with this type and shape, but writes nothing into it.
  void unwritten(const std::string& path, std::vector<hsize_t> shape, hid_t type) const {
    H5Dclose(dataset(path, shape, type, H5P_DEFAULT));
  }

  /// Writes a text attribute of variable length, like h5py, or of fixed length, like other
  /// programs.
  void text(const std::string& path, const std::string& name, const std::string& value,
            bool variable = true) const {
    const hid_t type = checked(H5Tcopy(H5T_C_S1));
    H5Tset_size(type, variable ? H5T_VARIABLE : value.size());
    const char* pointer = value.c_str();
    attribute(path, name, type, type, 1,
              variable ? static_cast<const void*>(&pointer) : value.c_str());
    H5Tclose(type);
  }

  void texts(const std::string& path, const std::string& name,
             const std::vector<const char*>& values) const {
    const hid_t type = checked(H5Tcopy(H5T_C_S1));
    H5Tset_size(type, H5T_VARIABLE);
    attribute(path, name, type, type, values.size(), values.data());
    H5Tclose(type);
  }

  void number(const std::string& path, const std::string& name, double value) const {
    attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &value);
  }

 private:
  template <typename Result>
  static Result checked(Result result) {
    if (result < 0) throw std::runtime_error("HDF5 does not write");
    return result;
  }

  hid_t dataset(const std::string& path, const std::vector<hsize_t>& shape, hid_t type,
                hid_t plan) const {
    const hid_t space =
        checked(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
    const hid_t set =
        checked(H5Dcreate2(file_, path.c_str(), type, space, links_, plan, H5P_DEFAULT));
    H5Sclose(space);
    return set;
  }

  void attribute(const std::string& path, const std::string& name, hid_t type, hid_t memory,
                 std::size_t count, const void* value) const {
    const hid_t object = checked(H5Oopen(file_, path.c_str(), H5P_DEFAULT));
    const auto size = static_cast<hsize_t>(count);
    const hid_t space =
        count == 1 ? checked(H5Screate(H5S_SCALAR)) : checked(H5Screate_simple(1, &size, nullptr));
    const hid_t made =
        checked(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
    checked(H5Awrite(made, memory, value));
    H5Aclose(made);
    H5Sclose(space);
    H5Oclose(object);
  }

  hid_t file_ = -1;
  hid_t links_ = -1;
};

}  // namespace rigcal::test
