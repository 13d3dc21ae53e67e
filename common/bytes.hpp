#pragma once

#include <cereal/archives/portable_binary.hpp>
#include <cereal/cereal.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>
#include <string>

// Converts values to bytes and back without changing a bit, for exchange between processes. A
// struct needs a function `template <typename Archive> void serialize(Archive&, Struct&)`.

namespace rigcal {

template <typename... Values>
std::string to_bytes(const Values&... values) {
  std::ostringstream stream;
  cereal::PortableBinaryOutputArchive archive(stream);
  archive(values...);
  return stream.str();
}

/// @throws cereal::Exception  if the bytes do not represent values of these types
template <typename... Values>
void from_bytes(const std::string& bytes, Values&... values) {
  std::istringstream stream(bytes);
  cereal::PortableBinaryInputArchive archive(stream);
  archive(values...);
}

}  // namespace rigcal
