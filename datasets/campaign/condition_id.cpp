#include "datasets/campaign/condition_id.hpp"

#include <algorithm>

namespace rigcal::datasets {
namespace {

constexpr std::size_t kLongestId = 200;

}  // namespace

bool is_condition_id(std::string_view text) {
  const bool allowed = std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  });
  return allowed && !text.empty() && text != "." && text != ".." && text.size() <= kLongestId;
}

std::string_view condition_id_rule() {
  return "an id of letters, digits, '.', '_' and '-' (it names files), at most 200 of them";
}

}  // namespace rigcal::datasets
