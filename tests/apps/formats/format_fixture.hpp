#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/mat_fixture.hpp"
#include "tests/datasets/xlsx_fixture.hpp"

namespace rigcal::test {

inline std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) result.push_back(cell);
  return result;
}

struct RecordColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

inline RecordColumns record_columns_of(const std::string& csv) {
  std::istringstream text(csv);
  std::string line;
  while (std::getline(text, line) && line.starts_with('#')) {
  }
  RecordColumns columns{cells(line), {}};
  columns.values.resize(columns.names.size());
  while (std::getline(text, line)) {
    const std::vector<std::string> row = cells(line);
    REQUIRE(row.size() == columns.names.size());
    for (std::size_t k = 0; k < row.size(); ++k)
      columns.values[k].push_back(std::strtod(row[k].c_str(), nullptr));
  }
  return columns;
}

/// Writes the columns as variables of a MAT file.
inline void as_mat(const RecordColumns& columns, const std::filesystem::path& path,
                   MatFormat format) {
  std::vector<matvar_t*> variables;
  for (std::size_t k = 0; k < columns.names.size(); ++k)
    variables.push_back(mat_array(columns.names[k], columns.values[k]));
  write_mat(path, format, variables);
}

/// Writes the columns as datasets, every second one in compressed chunks.
inline void as_hdf5(const RecordColumns& columns, const std::filesystem::path& path) {
  const Hdf5Writer file(path);
  for (std::size_t k = 0; k < columns.names.size(); ++k)
    file.array("/" + columns.names[k], columns.values[k], {}, H5T_IEEE_F64BE, k % 2 == 1);
}

inline void as_xlsx(const RecordColumns& columns, const std::filesystem::path& path) {
  XlsxRows rows(1);
  for (const std::string& name : columns.names) rows[0].push_back(cell(name));
  for (std::size_t i = 0; i < columns.values.at(0).size(); ++i) {
    rows.emplace_back();
    for (const auto& column : columns.values) rows.back().push_back(cell(column[i]));
  }
  write_xlsx(path, {{"Log", rows}});
}

/// A recording format, and a function that writes recordings in it.
struct RecordFormat {
  std::string name;
  std::string extension;
  std::function<void(const RecordColumns&, const std::filesystem::path&)> write;
};

inline const std::vector<RecordFormat>& record_formats() {
  static const auto mat = [](MatFormat format) {
    return [format](const RecordColumns& columns, const std::filesystem::path& path) {
      as_mat(columns, path, format);
    };
  };
  static const std::vector<RecordFormat> all{{"v6", ".mat", mat(MatFormat::v6)},
                                             {"v7", ".mat", mat(MatFormat::v7)},
                                             {"v73", ".mat", mat(MatFormat::v73)},
                                             {"hdf5", ".h5", as_hdf5},
                                             {"xlsx", ".xlsx", as_xlsx}};
  return all;
}

}  // namespace rigcal::test
