#include "datasets/read/record_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <system_error>

#include "common/error.hpp"
#include "datasets/read/csv/load_csv.hpp"
#include "datasets/read/hdf5/load_hdf5.hpp"
#include "datasets/read/mat/load_mat.hpp"
#include "datasets/read/mat/mat_columns.hpp"
#include "datasets/read/xlsx/load_xlsx.hpp"

namespace rigcal::datasets {
namespace {

/// One row per format. A file belongs to the first row whose `sniff` accepts it.
constexpr std::array kReaders{
    RecordReader{"MAT", ".mat", is_mat_file, mat_record_columns, load_mat_record, kHowToSaveMat},
    RecordReader{"HDF5", ".h5 .hdf5", is_hdf5_file, hdf5_record_columns, load_hdf5_record,
                 kHowToSaveHdf5},
    RecordReader{"Excel", ".xlsx .xlsm", is_xlsx_file, xlsx_record_columns, load_xlsx_record,
                 kHowToSaveXlsx},
    RecordReader{"CSV", ".csv", [](const FileStart&) { return true; }, csv_record_columns,
                 load_csv_record, "expected a header line"},
};

/// A known format that rigcal does not read.
struct OtherFormat {
  std::string_view name;
  std::string_view extensions;  ///< empty: recognised only by its bytes
  bool (*sniff)(std::string_view bytes);
  std::string_view instead;
};

bool is_universal_file(std::string_view bytes) {
  const auto word = [&bytes] {
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    const std::size_t end = std::min(bytes.find_first_of(" \t\r\n", begin), bytes.size());
    const std::string_view found = bytes.substr(begin, end - begin);
    bytes.remove_prefix(end);
    return found;
  };
  if (word() != "-1") return false;
  const std::string_view number = word();
  return number.starts_with("58") || number == "151";
}

constexpr std::array kOtherFormats{
    OtherFormat{"TDMS, of LabVIEW", ".tdms",
                [](std::string_view b) { return b.starts_with("TDSm") || b.starts_with("TDSh"); },
                "CSV or .lvm from LabVIEW or DIAdem, or HDF5 by npTDMS"},
    OtherFormat{
        "MDF, of ASAM", ".mf4 .mdf",
        [](std::string_view b) { return b.starts_with("MDF     ") || b.starts_with("UnFinMF "); },
        "CSV or HDF5, as by asammdf"},
    OtherFormat{"RPC III, of MTS", ".rsp .rpc",
                [](std::string_view b) { return b.starts_with(std::string_view("FORMAT\0", 7)); },
                "CSV from the rig's software"},
    OtherFormat{"UFF, the universal file format", ".uff .unv", is_universal_file,
                "CSV or MAT, as by pyuff"},
    OtherFormat{"NPY, of NumPy", ".npy",
                [](std::string_view b) { return b.starts_with("\x93NUMPY"); },
                "CSV by numpy.savetxt with a header, or HDF5"},
    OtherFormat{"NPZ, of NumPy", ".npz", [](std::string_view) { return false; },
                "CSV by numpy.savetxt with a header, or HDF5"},
    OtherFormat{"Parquet", ".parquet", [](std::string_view b) { return b.starts_with("PAR1"); },
                "CSV"},
    OtherFormat{"a file compressed by gzip", ".gz",
                [](std::string_view b) { return b.starts_with("\x1f\x8b"); },
                "the file in it (gunzip)"},
    OtherFormat{"a file compressed by bzip2", ".bz2",
                [](std::string_view b) { return b.starts_with("BZh"); },
                "the file in it (bunzip2)"},
    OtherFormat{"a file compressed by xz", ".xz",
                [](std::string_view b) {
                  return b.starts_with(
                      "\xfd"
                      "7zXZ");
                },
                "the file in it (unxz)"},
};

/// Extensions of text files that loggers write. Other kinds of text files use them, too.
constexpr std::string_view kTextExtensions = ".txt .dat .lvm .tsv .asc";

constexpr bool is_complete(const RecordReader& reader) {
  return !reader.name.empty() && reader.extensions.starts_with('.') && reader.sniff != nullptr &&
         reader.columns != nullptr && reader.load != nullptr && !reader.if_empty.empty();
}
static_assert(std::all_of(kReaders.begin(), kReaders.end(), is_complete),
              "a format lacks its name, an extension or a function");

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Reads the start of a file; empty unless the file is regular, because a pipe provides its bytes
/// only once.
FileStart start_of(const std::filesystem::path& path) {
  FileStart start{lower_extension(path), {}};
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return start;
  start.bytes.resize(4096);
  std::ifstream file(path, std::ios::binary);
  file.read(start.bytes.data(), static_cast<std::streamsize>(start.bytes.size()));
  start.bytes.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Calls `take` for each extension in a list.
template <typename Take>
void for_each_extension(std::string_view rest, Take take) {
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    take(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

/// Joins words as in "a, b or c".
std::string listed(const std::vector<std::string_view>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

bool has_extension(std::string_view extensions, const std::string& extension) {
  bool found = false;
  for_each_extension(extensions, [&](std::string_view own) { found = found || own == extension; });
  return found;
}

/// @throws InputError  if the file has a known format that rigcal does not read
void refuse_other_format(const std::filesystem::path& path, const FileStart& start) {
  const auto other =
      std::find_if(kOtherFormats.begin(), kOtherFormats.end(), [&](const OtherFormat& format) {
        return format.sniff(start.bytes) || has_extension(format.extensions, start.extension);
      });
  if (other == kOtherFormats.end() || start.bytes.empty()) return;
  throw InputError({path.string()}, fmt::format("is {}, which rigcal cannot read; expected {}",
                                                other->name, other->instead));
}

}  // namespace

const RecordReader& record_reader(const std::filesystem::path& path) {
  const FileStart start = start_of(path);
  refuse_other_format(path, start);
  return *std::find_if(kReaders.begin(), kReaders.end() - 1,
                       [&](const RecordReader& reader) { return reader.sniff(start); });
}

bool has_record_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return std::any_of(kReaders.begin(), kReaders.end(), [&](const RecordReader& reader) {
    return has_extension(reader.extensions, extension);
  });
}

bool may_be_recording(const std::filesystem::path& path) {
  return has_record_name(path) || has_extension(kTextExtensions, lower_extension(path));
}

bool has_other_format_name(const std::filesystem::path& path) {
  return std::any_of(kOtherFormats.begin(), kOtherFormats.end(), [&](const OtherFormat& format) {
    return has_extension(format.extensions, lower_extension(path));
  });
}

std::string record_format_names() {
  std::vector<std::string_view> names;
  for (const RecordReader& reader : kReaders) names.insert(names.begin(), reader.name);
  return listed(names);
}

std::string record_extensions() {
  std::vector<std::string_view> extensions;
  for (auto reader = kReaders.rbegin(); reader != kReaders.rend(); ++reader)
    for_each_extension(reader->extensions,
                       [&](std::string_view own) { extensions.push_back(own); });
  for_each_extension(kTextExtensions, [&](std::string_view own) { extensions.push_back(own); });
  return listed(extensions);
}

}  // namespace rigcal::datasets
