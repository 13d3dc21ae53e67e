#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

namespace rigcal::python {

/// Returns numbers from a result as a read-only NumPy array. The array shares the memory of the
/// result and keeps it alive.
template <typename T>
pybind11::array_t<T> view(std::shared_ptr<const void> owner, const T* data, std::size_t size) {
  auto* const kept = new std::shared_ptr<const void>(std::move(owner));
  const pybind11::capsule base(
      kept, [](void* memory) { delete static_cast<std::shared_ptr<const void>*>(memory); });
  pybind11::array_t<T> array(static_cast<pybind11::ssize_t>(size), data, base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

template <typename T>
pybind11::array_t<T> view(std::shared_ptr<const void> owner, const std::vector<T>& values) {
  return view(std::move(owner), values.data(), values.size());
}

/// Returns None if there are no values.
template <typename T>
std::optional<pybind11::array_t<T>> view_or_none(std::shared_ptr<const void> owner,
                                                 const std::vector<T>& values) {
  if (values.empty()) return std::nullopt;
  return view(std::move(owner), values);
}

/// Copies a matrix, shape (rows, columns).
inline pybind11::array_t<double> array_of(const Eigen::MatrixXd& matrix) {
  pybind11::array_t<double> array({matrix.rows(), matrix.cols()});
  auto values = array.mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values(i, j) = matrix(i, j);
  }
  return array;
}

}  // namespace rigcal::python
