#include "datasets/read/hdf5/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/error.hpp"
#include "datasets/read/hdf5/hdf5_attributes.hpp"
#include "datasets/read/limits.hpp"
#include "datasets/read/mat/mat_array.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kMostObjects = 200'000;
constexpr std::size_t kDeepestGroup = 32;
constexpr unsigned kMostMembers = 1000;

constexpr std::array kUnitAttributes{"unit", "units", "Unit", "Units", "unit_string"};

/// Attributes that give the sample interval in seconds or the sampling rate in hertz. npTDMS writes
/// the first one, for NI's TDMS waveforms.
struct ClockAttribute {
  const char* name;
  bool is_rate;
};
constexpr std::array kClockAttributes{ClockAttribute{"wf_increment", false},
                                      ClockAttribute{"dt", false},
                                      ClockAttribute{"sample_interval", false},
                                      ClockAttribute{"sample_rate", true},
                                      ClockAttribute{"sampling_rate", true},
                                      ClockAttribute{"sampling_frequency", true},
                                      ClockAttribute{"fs", true}};
/// Time of the first sample, stored next to "wf_increment".
constexpr const char* kStartAttribute = "wf_start_offset";

/// Names of the hard links in a group.
using Links = std::vector<std::string>;

/// Callback for HDF5. Must not throw, because HDF5 is written in C.
herr_t note_link(hid_t /*group*/, const char* name, const H5L_info_t* info, void* links) {
  auto& list = *static_cast<Links*>(links);
  if (list.size() >= kMostObjects) return 1;
  if (info->type == H5L_TYPE_HARD) list.emplace_back(name);
  return 0;
}

/// Describes a type that is not numeric, in words; empty if it is numeric.
std::string kind_of(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
    case H5T_FLOAT:
      return {};
    case H5T_STRING:
      return "text";
    case H5T_ENUM:
      return "an enumeration, such as truth values";
    case H5T_COMPOUND:
      return "a table within a table";
    case H5T_REFERENCE:
      return "a reference";
    case H5T_VLEN:
      return "a list of lists of different lengths";
    case H5T_TIME:
      return "a date";
    case H5T_BITFIELD:
      return "a field of bits";
    default:
      return "of a type that is not numeric";
  }
}

/// Appends the sizes. Returns false if the product of all dimensions overflows.
bool append_dims(const std::vector<hsize_t>& sizes, std::vector<std::size_t>& dims) {
  constexpr std::size_t kMost = std::numeric_limits<std::int64_t>::max();
  std::size_t count = 1;
  for (const std::size_t size : dims) count *= std::max<std::size_t>(size, 1);
  for (const hsize_t size : sizes) {
    if (size > 0 && count > kMost / size) return false;
    count *= std::max<hsize_t>(size, 1);
    dims.push_back(size);
  }
  return true;
}

/// Returns the element type of cells that are arrays, and appends their shape to `dims`. Returns
/// any other type unchanged.
Hdf5Id element_type(Hdf5Id type, Hdf5Series& series) {
  if (H5Tget_class(type.get()) != H5T_ARRAY) return type;
  const int rank = H5Tget_array_ndims(type.get());
  if (rank < 1 || rank > H5S_MAX_RANK) return {};
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  H5Tget_array_dims2(type.get(), sizes.data());
  if (!append_dims(sizes, series.dims)) return {};
  series.cell_dims = sizes.size();
  return Hdf5Id(H5Tget_super(type.get()), H5Tclose);
}

std::vector<std::string> units_of(hid_t object) {
  for (const char* name : kUnitAttributes) {
    std::vector<std::string> texts = hdf5_texts(object, name);
    if (!texts.empty()) return texts;
  }
  return {};
}

/// Whether a name can be used in a campaign file and on a terminal.
bool is_printable(const std::string& name) {
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= ' ' && c != '\x7f'; });
}

template <typename Number>
std::vector<double> exact(const std::vector<Number>& numbers, const std::string& file,
                          const std::string& column) {
  std::vector<double> values;
  values.reserve(numbers.size());
  for (const Number number : numbers) {
    values.push_back(static_cast<double>(number));
    if (!is_exact_as_double(number))
      throw InputError({file},
                       fmt::format("row {} of '{}' is {}, more than a double can hold exactly",
                                   values.size(), column, number));
  }
  return values;
}

// ---- Numbers -------------------------------------------------------------------------------

std::size_t dims_of_dataset(const Hdf5Series& series) {
  return series.dims.size() - series.cell_dims;
}

/// The wanted numbers from a selection of cells with `width` numbers each: first, first + stride,
/// ..., `wanted` in all.
struct CellChoice {
  std::size_t cells = 1;
  std::size_t width = 1;
  std::size_t first = 0;
  std::size_t stride = 1;
  std::size_t wanted = 1;
};

CellChoice choice_of(const Hdf5Series& series, const Hdf5Line& line) {
  CellChoice choice;
  const std::size_t own_dims = dims_of_dataset(series);
  for (std::size_t k = series.dims.size(); k-- > own_dims;) {
    if (k == line.along)
      choice.stride = choice.width;
    else
      choice.first += line.fixed[k] * choice.width;
    choice.width *= series.dims[k];
  }
  if (series.dims.empty()) return choice;
  choice.wanted = series.dims[line.along];
  if (line.along < own_dims) {
    choice.cells = choice.wanted;
    choice.stride = choice.width;
  }
  return choice;
}

/// Selects the cells along the line in the file.
bool select_cells(hid_t space, const Hdf5Series& series, const Hdf5Line& line) {
  const std::size_t own_dims = dims_of_dataset(series);
  if (own_dims == 0) return true;
  std::vector<hsize_t> start(line.fixed.begin(),
                             line.fixed.begin() + static_cast<std::ptrdiff_t>(own_dims));
  std::vector<hsize_t> count(own_dims, 1);
  if (line.along < own_dims) {
    start[line.along] = 0;
    count[line.along] = series.dims[line.along];
  }
  return H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >=
         0;
}

/// Returns the type that the numbers have in the file.
Hdf5Id number_type(hid_t dataset, const Hdf5Series& series) {
  Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  if (!series.member.empty()) {
    const int index = H5Tget_member_index(type.get(), series.member.c_str());
    if (index < 0) return {};
    type = Hdf5Id(H5Tget_member_type(type.get(), static_cast<unsigned>(index)), H5Tclose);
  }
  while (H5Tget_class(type.get()) == H5T_ARRAY) type = Hdf5Id(H5Tget_super(type.get()), H5Tclose);
  return type;
}

/// Returns the memory type for a cell of the series: numbers of a native type, wrapped in an array
/// or in a table with one member if the file stores them that way.
Hdf5Id type_in_memory(const Hdf5Series& series, hid_t native, std::size_t bytes) {
  const std::vector<hsize_t> shape(
      series.dims.begin() + static_cast<std::ptrdiff_t>(dims_of_dataset(series)),
      series.dims.end());
  Hdf5Id type(shape.empty()
                  ? H5Tcopy(native)
                  : H5Tarray_create2(native, static_cast<unsigned>(shape.size()), shape.data()),
              H5Tclose);
  if (series.member.empty()) return type;
  Hdf5Id table(H5Tcreate(H5T_COMPOUND, bytes), H5Tclose);
  H5Tinsert(table.get(), series.member.c_str(), 0, type.get());
  return table;
}

/// Packing of numbers according to the conventions for climate and forecast metadata (CF 1.11,
/// 2.5.1 and 8.1), which are used in netCDF and other files: value = factor * number + offset.
struct Packing {
  double factor = 1.0;
  double offset = 0.0;
  bool is_given = false;        ///< false: numbers are returned unchanged
  std::vector<double> missing;  ///< numbers that mark a missing value
};

/// Returns the value that HDF5 gives for elements that were never written, if the file sets one.
/// Zero is ignored, because it may be a real value.
std::optional<double> own_fill_value(hid_t dataset) {
  const Hdf5Id plan(H5Dget_create_plist(dataset), H5Pclose);
  H5D_fill_value_t kind = H5D_FILL_VALUE_UNDEFINED;
  if (!plan || H5Pfill_value_defined(plan.get(), &kind) < 0) return std::nullopt;
  if (kind != H5D_FILL_VALUE_USER_DEFINED) return std::nullopt;
  double value = 0.0;
  if (H5Pget_fill_value(plan.get(), H5T_NATIVE_DOUBLE, &value) < 0) return std::nullopt;
  return value == 0.0 ? std::nullopt : std::optional(value);
}

}  // namespace

std::size_t Hdf5Series::element_count() const {
  std::size_t count = 1;
  for (const std::size_t n : dims) count *= n;
  return count;
}

Hdf5File::Hdf5File(const std::filesystem::path& path) : name_(path.string()) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // keeps HDF5 from printing errors
  H5PLset_loading_state(0);                     // loads no plugins from a path in the environment
  file_ = Hdf5Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file_)
    fail(fmt::format(
        "is truncated or damaged, or not an HDF5 file (HDF5: {}); copy or save it again",
        hdf5_reason()));
  const Hdf5Id root(H5Gopen2(file_.get(), "/", H5P_DEFAULT), H5Gclose);
  if (!root) fail(fmt::format("is damaged (HDF5: {}); copy or save it again", hdf5_reason()));
  std::vector<haddr_t> above;
  list_group(root.get(), "", above);
}

void Hdf5File::fail(const std::string& message) const { throw InputError({name_}, message); }

void Hdf5File::list_group(hid_t group, const std::string& path, std::vector<haddr_t>& above) {
  // A reference gives the address of an object. H5Oget_info would return it in a type that depends
  // on the version.
  hobj_ref_t address{};
  if (H5Rcreate(&address, group, ".", H5R_OBJECT, -1) < 0 || above.size() >= kDeepestGroup) return;
  if (std::find(above.begin(), above.end(), address) != above.end()) return;  // a cycle of links
  above.push_back(address);
  list_clocks(group, path, true);
  Links links;
  if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_link, &links) < 0)
    fail(fmt::format("is damaged in group '{}/' (HDF5: {}); copy or save it again", path,
                     hdf5_reason()));
  for (const std::string& name : links) {
    if (++objects_ > kMostObjects)
      fail(fmt::format("contains more than {} groups and datasets", kMostObjects));
    if (!is_printable(name)) continue;
    const std::string own = fmt::format("{}/{}", path, name);
    const Hdf5Id object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (!object)
      fail(fmt::format("is damaged at '{}' (HDF5: {}); copy or save it again", own, hdf5_reason()));
    const H5I_type_t type = H5Iget_type(object.get());
    if (type == H5I_GROUP) list_group(object.get(), own, above);
    if (type == H5I_DATASET) list_dataset(object.get(), own);
  }
  above.pop_back();
}

void Hdf5File::list_dataset(hid_t dataset, const std::string& path) {
  Hdf5Series series{path, path, {}, {}, 0, {}, units_of(dataset)};
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  const int rank = space ? H5Sget_simple_extent_ndims(space.get()) : -1;
  if (!type || rank < 0)
    fail(fmt::format("is damaged at '{}' (HDF5: {}); copy or save it again", path, hdf5_reason()));
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr);
  if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) sizes = {0};
  if (!append_dims(sizes, series.dims))
    fail(fmt::format("is damaged at '{}' (dimensions too large for any file)", path));
  if (H5Tget_class(type.get()) != H5T_COMPOUND) {
    type = element_type(std::move(type), series);
    series.kind = type ? kind_of(type.get()) : "of a damaged type";
    if (series.kind.empty() && series.dims.size() == 1) list_clocks(dataset, path, false);
    series_.push_back(std::move(series));
    return;
  }
  const int members = H5Tget_nmembers(type.get());
  const std::vector<std::string> units = std::move(series.units);
  series.units.clear();
  series.kind = "a table";
  series_.push_back(series);
  for (unsigned i = 0; members > 0 && i < std::min(static_cast<unsigned>(members), kMostMembers);
       ++i) {
    char* name = H5Tget_member_name(type.get(), i);
    if (name == nullptr) continue;
    Hdf5Series own = series;
    own.member = name;
    H5free_memory(name);
    if (!is_printable(own.member)) continue;
    own.path = path + "." + own.member;
    const Hdf5Id cell = element_type(Hdf5Id(H5Tget_member_type(type.get(), i), H5Tclose), own);
    own.kind = cell ? kind_of(cell.get()) : "of a damaged type";
    if (units.size() == static_cast<std::size_t>(members)) own.units = {units[i]};
    if (++objects_ > kMostObjects)
      fail(fmt::format("contains more than {} datasets and members of tables", kMostObjects));
    series_.push_back(std::move(own));
  }
}

void Hdf5File::list_clocks(hid_t object, const std::string& path, bool is_group) {
  for (const ClockAttribute& attribute : kClockAttributes) {
    const auto value = hdf5_number(object, attribute.name);
    if (!value || !std::isfinite(*value) || !(*value > 0.0)) continue;
    Hdf5Clock clock{path + "@" + attribute.name, is_group ? std::string() : path};
    (attribute.is_rate ? clock.rate_hz : clock.step_s) = *value;
    if (!attribute.is_rate) clock.start_s = hdf5_number(object, kStartAttribute).value_or(0.0);
    clocks_.push_back(std::move(clock));
  }
}

void Hdf5File::require_readable(hid_t dataset, const std::string& column) const {
  const Hdf5Id plan(H5Dget_create_plist(dataset), H5Pclose);
  if (!plan) fail(fmt::format("is damaged at '{}' (HDF5: {})", column, hdf5_reason()));
  if (H5Pget_layout(plan.get()) == H5D_VIRTUAL || H5Pget_external_count(plan.get()) > 0)
    fail(fmt::format("'{}' is stored in another file; expected numbers in this one", column));
  for (int i = 0; i < H5Pget_nfilters(plan.get()); ++i) {
    std::array<char, 40> name{};
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(plan.get(), static_cast<unsigned>(i), &flags,
                                               &values, nullptr, name.size(), name.data(), nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) > 0) continue;
    name.back() = '\0';
    fail(
        fmt::format("'{}' is compressed by the filter {} ({}), which is not built into HDF5; save "
                    "it with gzip, or uncompressed",
                    column, filter, is_printable(name.data()) ? name.data() : "?"));
  }
  H5D_space_status_t status = H5D_SPACE_STATUS_ERROR;
  if (H5Dget_space_status(dataset, &status) >= 0 && status == H5D_SPACE_STATUS_NOT_ALLOCATED)
    fail(fmt::format("'{}' was never written: it has a shape, but no numbers", column));
}

void Hdf5File::require_written(hid_t dataset, const Hdf5Series& series, const Hdf5Line& line,
                               const std::string& column) const {
  const Hdf5Id plan(H5Dget_create_plist(dataset), H5Pclose);
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const std::size_t rank = dims_of_dataset(series);
  if (!plan || rank == 0 || H5Pget_layout(plan.get()) != H5D_CHUNKED) return;
  std::vector<hsize_t> chunk(rank);
  hsize_t written = 0;
  if (H5Pget_chunk(plan.get(), static_cast<int>(rank), chunk.data()) != static_cast<int>(rank) ||
      std::count(chunk.begin(), chunk.end(), 0U) > 0 ||
      H5Dget_num_chunks(dataset, space.get(), &written) < 0)
    fail(
        fmt::format("is damaged at '{}' (HDF5: {}); copy or save it again", column, hdf5_reason()));
  hsize_t wanted = 1;
  for (std::size_t k = 0; k < rank; ++k) wanted *= (series.dims[k] + chunk[k] - 1) / chunk[k];
  if (written >= wanted) return;
  std::vector<hsize_t> at(rank);
  for (std::size_t k = 0; k < rank; ++k) at[k] = line.fixed[k] / chunk[k] * chunk[k];
  const bool is_along_chunks = line.along < rank;
  const hsize_t rows = is_along_chunks ? series.dims[line.along] : 1;
  const hsize_t step = is_along_chunks ? chunk[line.along] : 1;
  for (hsize_t row = 0; row < rows; row += step) {
    if (is_along_chunks) at[line.along] = row;
    unsigned filters = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t bytes = 0;
    if (H5Dget_chunk_info_by_coord(dataset, at.data(), &filters, &address, &bytes) >= 0 &&
        address != HADDR_UNDEF)
      continue;
    fail(
        fmt::format("rows {} to {} of '{}' were never written: the file has no numbers there; "
                    "expected a number in each row",
                    row + 1, std::min(row + step, rows), column));
  }
}

std::vector<double> Hdf5File::unpacked(hid_t dataset, std::vector<double> values,
                                       const std::string& column) const {
  Packing packing;
  const auto number_of = [&](const char* attribute, double& number) {
    const auto found = hdf5_numbers(dataset, attribute);
    if (!found) return;
    if (found->size() != 1 || !std::isfinite(found->front()))
      fail(
          fmt::format("the attribute '{}' of '{}' is not one finite number; expected one, by which "
                      "its values are unpacked",
                      attribute, column));
    number = found->front();
    packing.is_given = true;
  };
  number_of("scale_factor", packing.factor);
  number_of("add_offset", packing.offset);
  for (const char* attribute : {"_FillValue", "missing_value"})
    if (const auto found = hdf5_numbers(dataset, attribute))
      packing.missing.insert(packing.missing.end(), found->begin(), found->end());
  if (const auto fill = own_fill_value(dataset)) packing.missing.push_back(*fill);
  const Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  if (H5Tget_class(type.get()) == H5T_FLOAT && H5Tget_size(type.get()) == sizeof(float)) {
    // A dataset of floats stores -999.9 in single precision, so the attribute is rounded to it as
    // well.
    for (double& each : packing.missing)
      if (std::abs(each) <= static_cast<double>(std::numeric_limits<float>::max()))
        each = static_cast<double>(static_cast<float>(each));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::find(packing.missing.begin(), packing.missing.end(), values[i]) !=
        packing.missing.end())
      fail(
          fmt::format("row {} of '{}' is {}, which means a missing value there; expected a "
                      "number in each row",
                      i + 1, column, values[i]));
    if (packing.is_given) values[i] = packing.factor * values[i] + packing.offset;
  }
  return values;
}

std::vector<double> Hdf5File::numbers(const Hdf5Series& series, const Hdf5Line& line,
                                      const std::string& column) const {
  const auto damaged = [&]() {
    fail(fmt::format("'{}' cannot be read (HDF5: {}): the file is damaged; copy or save it again",
                     column, hdf5_reason()));
  };
  const Hdf5Id dataset(H5Dopen2(file_.get(), series.dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) damaged();
  require_readable(dataset.get(), column);
  require_written(dataset.get(), series, line, column);
  const CellChoice choice = choice_of(series, line);
  if (choice.width > kMostValues / std::max<std::size_t>(choice.cells, 1))
    fail(
        fmt::format("'{}' has arrays of {} numbers each, {} of them: more than {} numbers in total",
                    column, choice.width, choice.cells, kMostValues));
  const Hdf5Id space(H5Dget_space(dataset.get()), H5Sclose);
  const Hdf5Id type = number_type(dataset.get(), series);
  if (!type || !select_cells(space.get(), series, line)) damaged();
  const bool is_float = H5Tget_class(type.get()) == H5T_FLOAT;
  const bool is_signed = !is_float && H5Tget_sign(type.get()) == H5T_SGN_2;

  const auto read_raw = [&](auto zero, hid_t native) {
    using Number = decltype(zero);
    std::vector<Number> raw(choice.cells * choice.width);
    const Hdf5Id memory = type_in_memory(series, native, choice.width * sizeof(Number));
    const auto rows = static_cast<hsize_t>(choice.cells);
    const Hdf5Id plain(H5Screate_simple(1, &rows, nullptr), H5Sclose);
    if (H5Dread(dataset.get(), memory.get(), plain.get(), space.get(), H5P_DEFAULT, raw.data()) < 0)
      damaged();
    std::vector<Number> chosen(choice.wanted);
    for (std::size_t i = 0; i < choice.wanted; ++i)
      chosen[i] = raw[choice.first + i * choice.stride];
    return exact(chosen, name_, column);
  };
  std::vector<double> values = is_float    ? read_raw(double{}, H5T_NATIVE_DOUBLE)
                               : is_signed ? read_raw(std::int64_t{}, H5T_NATIVE_INT64)
                                           : read_raw(std::uint64_t{}, H5T_NATIVE_UINT64);
  // The attributes of a table do not apply to individual members.
  return series.member.empty() ? unpacked(dataset.get(), std::move(values), column) : values;
}

}  // namespace rigcal::datasets
