#include "datasets/read/mat/mat_hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <matio.h>

#include <cstdint>
#include <limits>
#include <type_traits>

#include "common/error.hpp"
#include "datasets/read/hdf5/hdf5_file.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kMostHdf5Arrays = 200'000;
constexpr int kDeepestHdf5Struct = 32;

MatKind kind_of_class(matio_classes type) {
  if (type >= MAT_C_DOUBLE && type <= MAT_C_UINT64) return MatKind::number;
  switch (type) {
    case MAT_C_CELL:
      return MatKind::cell;
    case MAT_C_STRUCT:
      return MatKind::structure;
    case MAT_C_CHAR:
      return MatKind::text;
    case MAT_C_SPARSE:
      return MatKind::sparse;
    case MAT_C_FUNCTION:
      return MatKind::function;
    default:
      return MatKind::object;
  }
}

}  // namespace

struct Hdf5Source::Open {
  struct CloseMat {
    void operator()(mat_t* opened) const { Mat_Close(opened); }
  };
  struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
  };

  std::string name;
  std::unique_ptr<mat_t, CloseMat> file;
  std::vector<std::unique_ptr<matvar_t, FreeVariable>> roots;
  std::vector<matvar_t*> arrays;  ///< indexed by MatArray::place
  std::vector<MatArray> variables;

  [[noreturn]] void fail(const std::string& message) const { throw InputError({name}, message); }

  MatArray described(matvar_t& variable, int depth) {
    MatArray array;
    if (variable.name != nullptr) array.name = variable.name;
    array.kind = kind_of_class(variable.class_type);
    array.is_complex = variable.isComplex != 0;
    array.place = arrays.size();
    arrays.push_back(&variable);
    if (arrays.size() > kMostHdf5Arrays || depth > kDeepestHdf5Struct)
      fail(fmt::format("contains more than {} arrays, or structs nested more than {} deep",
                       kMostHdf5Arrays, kDeepestHdf5Struct));
    std::size_t count = 1;
    for (int i = 0; variable.dims != nullptr && i < variable.rank; ++i) {
      const std::size_t size = variable.dims[i];
      constexpr std::size_t kMostElements = std::numeric_limits<std::int64_t>::max();
      if (size > 0 && count > kMostElements / size)
        fail("is damaged (dimensions too large for any file); copy or save it again");
      count *= size;
      array.dims.push_back(size);
    }
    if (array.kind == MatKind::structure) describe_fields(array, variable, depth);
    if (array.dims.empty() && array.kind == MatKind::number) array.kind = MatKind::empty;
    return array;
  }

  void describe_fields(MatArray& array, matvar_t& variable, int depth) {
    const unsigned count = Mat_VarGetNumberOfFields(&variable);
    char* const* names = Mat_VarGetStructFieldnames(&variable);
    if (names == nullptr) return;
    array.field_names.assign(names, names + count);
    for (std::size_t element = 0; element < array.element_count(); ++element) {
      for (const std::string& field : array.field_names) {
        matvar_t* found = Mat_VarGetStructFieldByName(&variable, field.c_str(), element);
        array.fields.push_back(found != nullptr ? described(*found, depth + 1) : MatArray{});
      }
    }
  }

  template <typename Number>
  std::vector<double> numbers(matvar_t& variable, const MatSelection& selection,
                              const std::string& column) const {
    std::vector<Number> raw(selection.count);
    const int error = Mat_VarReadDataLinear(
        file.get(), &variable, raw.data(), static_cast<int>(selection.start),
        static_cast<int>(selection.stride), static_cast<int>(selection.count));
    if (error != 0)
      fail(
          fmt::format("'{}' cannot be read (matio: error {}): the file is damaged", column, error));
    if constexpr (std::is_same_v<Number, double>) {
      return raw;
    } else {
      for (std::size_t i = 0; i < raw.size(); ++i) {
        if (!is_exact_as_double(raw[i]))
          fail(fmt::format("element {} of '{}' is {}, more than a double can hold exactly", i + 1,
                           column, raw[i]));
      }
      return {raw.begin(), raw.end()};
    }
  }
};

Hdf5Source::Hdf5Source(const std::filesystem::path& path) : open_(std::make_unique<Open>()) {
  open_->name = path.string();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // keeps HDF5 from printing errors
  const hid_t probe = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (probe < 0)
    open_->fail(
        fmt::format("is truncated or damaged (HDF5: {}); copy or save it again", hdf5_reason()));
  H5Fclose(probe);
  open_->file.reset(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (!open_->file) open_->fail("cannot be read as a MAT file");
  while (matvar_t* next = Mat_VarReadNextInfo(open_->file.get())) open_->roots.emplace_back(next);
  for (const auto& root : open_->roots) open_->variables.push_back(open_->described(*root, 0));
}

Hdf5Source::~Hdf5Source() = default;

const std::string& Hdf5Source::name() const { return open_->name; }

const std::vector<MatArray>& Hdf5Source::variables() const { return open_->variables; }

std::vector<double> Hdf5Source::numbers(const MatArray& array, const MatSelection& selection,
                                        const std::string& column) {
  constexpr std::size_t kMostIndex = std::numeric_limits<int>::max();
  if (array.element_count() > kMostIndex)
    open_->fail(
        fmt::format("'{}' belongs to an array of more than {} elements", column, kMostIndex));
  matvar_t& variable = *open_->arrays.at(array.place);
  switch (variable.class_type) {
    case MAT_C_SINGLE:
      return open_->numbers<float>(variable, selection, column);
    case MAT_C_INT8:
      return open_->numbers<std::int8_t>(variable, selection, column);
    case MAT_C_UINT8:
      return open_->numbers<std::uint8_t>(variable, selection, column);
    case MAT_C_INT16:
      return open_->numbers<std::int16_t>(variable, selection, column);
    case MAT_C_UINT16:
      return open_->numbers<std::uint16_t>(variable, selection, column);
    case MAT_C_INT32:
      return open_->numbers<std::int32_t>(variable, selection, column);
    case MAT_C_UINT32:
      return open_->numbers<std::uint32_t>(variable, selection, column);
    case MAT_C_INT64:
      return open_->numbers<std::int64_t>(variable, selection, column);
    case MAT_C_UINT64:
      return open_->numbers<std::uint64_t>(variable, selection, column);
    default:
      return open_->numbers<double>(variable, selection, column);
  }
}

}  // namespace rigcal::datasets
