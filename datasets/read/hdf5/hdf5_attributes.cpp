#include "datasets/read/hdf5/hdf5_attributes.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "datasets/read/hdf5/hdf5_file.hpp"

namespace rigcal::datasets {
namespace {

constexpr hssize_t kMostTexts = 1000;
constexpr hssize_t kMostNumbers = 1000;
constexpr std::size_t kLongestText = 40;

struct Attribute {
  Hdf5Id id;
  Hdf5Id type;
  hssize_t count = 0;
};

std::optional<Attribute> opened(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return std::nullopt;
  Attribute attribute;
  attribute.id = Hdf5Id(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.id) return std::nullopt;
  attribute.type = Hdf5Id(H5Aget_type(attribute.id.get()), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute.id.get()), H5Sclose);
  if (!attribute.type || !space) return std::nullopt;
  attribute.count = H5Sget_simple_extent_npoints(space.get());
  return attribute;
}

/// Removes spaces and NULs from both ends of a text.
std::string text_without_padding(std::string_view text) {
  constexpr std::string_view kAround(" \t\0", 3);
  const std::size_t first = text.find_first_not_of(kAround);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kAround) - first + 1));
}

bool is_plain(const std::string& text) {
  return text.size() <= kLongestText && std::all_of(text.begin(), text.end(), [](char c) {
           return static_cast<unsigned char>(c) >= ' ' && c != '\x7f';
         });
}

std::vector<std::string> variable_texts(const Attribute& attribute) {
  std::vector<char*> raw(static_cast<std::size_t>(attribute.count), nullptr);
  const Hdf5Id type(H5Tcopy(attribute.type.get()), H5Tclose);
  if (H5Aread(attribute.id.get(), type.get(), raw.data()) < 0) return {};
  std::vector<std::string> texts;
  for (const char* each : raw)
    texts.push_back(each == nullptr ? std::string() : text_without_padding(std::string_view(each)));
  const Hdf5Id space(H5Aget_space(attribute.id.get()), H5Sclose);
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, raw.data());
  return texts;
}

std::vector<std::string> fixed_texts(const Attribute& attribute) {
  const std::size_t size = H5Tget_size(attribute.type.get());
  if (size == 0 || size > 64 * kLongestText) return {};
  std::string raw(size * static_cast<std::size_t>(attribute.count), '\0');
  if (H5Aread(attribute.id.get(), attribute.type.get(), raw.data()) < 0) return {};
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < raw.size(); at += size) {
    const std::string_view padded = std::string_view(raw).substr(at, size);
    texts.push_back(text_without_padding(padded.substr(0, padded.find('\0'))));
  }
  return texts;
}

}  // namespace

std::vector<std::string> hdf5_texts(hid_t object, const char* attribute) {
  const auto found = opened(object, attribute);
  if (!found || found->count < 1 || found->count > kMostTexts) return {};
  if (H5Tget_class(found->type.get()) != H5T_STRING) return {};
  auto texts =
      H5Tis_variable_str(found->type.get()) > 0 ? variable_texts(*found) : fixed_texts(*found);
  if (!std::all_of(texts.begin(), texts.end(), is_plain)) return {};
  return texts;
}

std::optional<double> hdf5_number(hid_t object, const char* attribute) {
  const auto numbers = hdf5_numbers(object, attribute);
  return numbers && numbers->size() == 1 ? std::optional(numbers->front()) : std::nullopt;
}

std::optional<std::vector<double>> hdf5_numbers(hid_t object, const char* attribute) {
  if (H5Aexists(object, attribute) <= 0) return std::nullopt;
  const auto found = opened(object, attribute);
  if (!found || found->count < 1 || found->count > kMostNumbers) return std::vector<double>();
  const H5T_class_t kind = H5Tget_class(found->type.get());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) return std::vector<double>();
  std::vector<double> values(static_cast<std::size_t>(found->count));
  if (H5Aread(found->id.get(), H5T_NATIVE_DOUBLE, values.data()) < 0) values.clear();
  return values;
}

}  // namespace rigcal::datasets
