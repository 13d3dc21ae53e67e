#pragma once

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t most_bytes);

namespace rigcal::fuzz {

using Json = nlohmann::ordered_json;

/// Collects all values within a JSON value, including itself.
inline void collect_values(Json& json, std::vector<Json*>& values) {
  values.push_back(&json);
  if (json.is_structured())
    for (Json& child : json) collect_values(child, values);
}

/// A value that readers do not expect.
inline Json odd_value(std::mt19937& random) {
  static const std::vector<Json> odd{nullptr,
                                     true,
                                     "",
                                     "text",
                                     Json::array(),
                                     Json::object(),
                                     {1.0},
                                     {nullptr, nullptr},
                                     {2.0, 1.0, 0.0},
                                     0,
                                     -1,
                                     1,
                                     2,
                                     0.5,
                                     1000000,
                                     2147483648LL,
                                     -9223372036854775807LL,
                                     1e308,
                                     -1e308,
                                     1e-308,
                                     "..",
                                     "converged",
                                     "failed",
                                     "rig"};
  return odd[random() % odd.size()];
}

/// Changes one value in a JSON text. Changing bytes would leave hardly any text that parses.
inline void mutate_json(Json& json, std::mt19937& random) {
  std::vector<Json*> values;
  collect_values(json, values);
  Json& value = *values[random() % values.size()];
  Json& other = *values[random() % values.size()];
  switch (random() % 5) {
    case 0:
      value = odd_value(random);
      break;
    case 1:  // copied, because one value may contain the other
      value = Json(other);
      break;
    case 2:
      if (value.is_structured() && !value.empty())
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(random() % value.size())));
      break;
    case 3:
      if (value.is_array()) value.push_back(value.empty() ? odd_value(random) : value.front());
      break;
    default:
      if (value.is_number()) value = value.get<double>() * (random() % 2 == 0 ? -1.0 : 1e6);
  }
}

/// The body of LLVMFuzzerCustomMutator() for JSON inputs. Other inputs are changed byte by byte.
inline std::size_t mutate_json_text(std::uint8_t* data, std::size_t size, std::size_t most_bytes,
                                    unsigned seed) {
  std::mt19937 random(seed);
  Json json = random() % 20 == 0 ? Json(Json::value_t::discarded)
                                 : Json::parse(text_of_bytes(data, size), nullptr, false);
  if (json.is_discarded()) return LLVMFuzzerMutate(data, size, most_bytes);
  for (unsigned changes = 1 + random() % 3; changes > 0; --changes) mutate_json(json, random);
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > most_bytes) return LLVMFuzzerMutate(data, size, most_bytes);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace rigcal::fuzz
