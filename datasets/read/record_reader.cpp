#include "datasets/read/record_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <system_error>

#include "datasets/read/csv/load_csv.hpp"
#include "datasets/read/hdf5/load_hdf5.hpp"
#include "datasets/read/mat/load_mat.hpp"
#include "datasets/read/mat/mat_columns.hpp"
#include "datasets/read/xlsx/load_xlsx.hpp"

namespace rigcal::datasets {
namespace {

/// One row per format; a file belongs to the first row whose sniff says so.
constexpr std::array kReaders{
    RecordReader{"MAT", ".mat", is_mat_file, mat_record_columns, load_mat_record, kHowToSaveMat},
    RecordReader{"HDF5", ".h5 .hdf5", is_hdf5_file, hdf5_record_columns, load_hdf5_record,
                 kHowToSaveHdf5},
    RecordReader{"Excel", ".xlsx .xlsm", is_xlsx_file, xlsx_record_columns, load_xlsx_record,
                 kHowToSaveXlsx},
    RecordReader{"CSV", ".csv", [](const FileStart&) { return true; }, csv_record_columns,
                 load_csv_record, "expected a header line"},
};

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

/// What is no regular file has no start: a pipe would give its bytes only once.
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

/// Calls `take` with each of the extensions.
template <typename Take>
void for_each_extension(const RecordReader& reader, Take take) {
  std::string_view rest = reader.extensions;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    take(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

/// "a, b or c"
std::string listed(const std::vector<std::string_view>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

const RecordReader& record_reader(const std::filesystem::path& path) {
  const FileStart start = start_of(path);
  return *std::find_if(kReaders.begin(), kReaders.end() - 1,
                       [&](const RecordReader& reader) { return reader.sniff(start); });
}

bool has_record_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  bool found = false;
  for (const RecordReader& reader : kReaders)
    for_each_extension(reader, [&](std::string_view own) { found = found || own == extension; });
  return found;
}

std::string record_format_names() {
  std::vector<std::string_view> names;
  for (const RecordReader& reader : kReaders) names.insert(names.begin(), reader.name);
  return listed(names);
}

std::string record_extensions() {
  std::vector<std::string_view> extensions;
  for (auto reader = kReaders.rbegin(); reader != kReaders.rend(); ++reader)
    for_each_extension(*reader, [&](std::string_view own) { extensions.push_back(own); });
  return listed(extensions);
}

}  // namespace rigcal::datasets
