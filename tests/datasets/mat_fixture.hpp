#pragma once

#include <matio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace rigcal::test {

/// Storage of a MAT file: "-v6", "-v7" and "-v7.3" in MATLAB's save.
enum class MatFormat { v6, v7, v73 };

template <typename Number>
constexpr matio_classes class_of() {
  if (std::is_same_v<Number, float>) return MAT_C_SINGLE;
  if (std::is_same_v<Number, std::int8_t>) return MAT_C_INT8;
  if (std::is_same_v<Number, std::uint16_t>) return MAT_C_UINT16;
  if (std::is_same_v<Number, std::int64_t>) return MAT_C_INT64;
  return MAT_C_DOUBLE;
}

template <typename Number>
constexpr matio_types type_of() {
  if (std::is_same_v<Number, float>) return MAT_T_SINGLE;
  if (std::is_same_v<Number, std::int8_t>) return MAT_T_INT8;
  if (std::is_same_v<Number, std::uint16_t>) return MAT_T_UINT16;
  if (std::is_same_v<Number, std::int64_t>) return MAT_T_INT64;
  return MAT_T_DOUBLE;
}

/// Creates a real array of any shape, column by column; a vector if no shape is given.
template <typename Number>
matvar_t* mat_array(const std::string& name, const std::vector<Number>& values,
                    std::vector<std::size_t> dims = {}) {
  if (dims.empty()) dims = {values.size(), 1};
  return Mat_VarCreate(name.c_str(), class_of<Number>(), type_of<Number>(),
                       static_cast<int>(dims.size()), dims.data(),
                       const_cast<Number*>(values.data()), 0);
}

inline matvar_t* mat_text(const std::string& name, const std::string& text) {
  std::vector<std::size_t> dims{1, text.size()};
  return Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UTF8, 2, dims.data(),
                       const_cast<char*>(text.data()), 0);
}

/// Creates a struct array: one list of fields per element, all with the same names; a row if no
/// shape is given.
inline matvar_t* mat_struct(const std::string& name,
                            const std::vector<std::vector<matvar_t*>>& elements,
                            std::vector<std::size_t> dims = {}) {
  std::vector<const char*> names;
  for (const matvar_t* field : elements.front()) names.push_back(field->name);
  if (dims.empty()) dims = {1, elements.size()};
  matvar_t* result = Mat_VarCreateStruct(name.c_str(), static_cast<int>(dims.size()), dims.data(),
                                         names.data(), static_cast<unsigned>(names.size()));
  for (std::size_t k = 0; k < elements.size(); ++k)
    for (matvar_t* field : elements[k]) Mat_VarSetStructFieldByName(result, field->name, k, field);
  return result;
}

/// Writes variables using matio, and frees them.
inline void write_mat(const std::filesystem::path& path, MatFormat format,
                      const std::vector<matvar_t*>& variables) {
  std::filesystem::create_directories(path.parent_path());
  mat_t* file =
      Mat_CreateVer(path.c_str(), nullptr, format == MatFormat::v73 ? MAT_FT_MAT73 : MAT_FT_MAT5);
  if (file == nullptr) throw std::runtime_error("cannot write " + path.string());
  int error = 0;
  for (matvar_t* variable : variables) {
    error += Mat_VarWrite(file, variable,
                          format == MatFormat::v7 ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }
  Mat_Close(file);
  if (error != 0) throw std::runtime_error("cannot write into " + path.string());
}

}  // namespace rigcal::test
