#include "datasets/read/mat/mat_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

namespace rigcal::datasets {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

[[noreturn]] void fail(const std::string& text, const std::string& message) {
  throw std::invalid_argument(
      fmt::format("'{}' {}; expected a variable as MATLAB names it, such as x, log.time, "
                  "log.signals(2).values or data(:,3)",
                  text, message));
}

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text), rest_(text) {}

  std::vector<MatStep> parse() {
    std::vector<MatStep> steps{step()};
    while (take('.')) steps.push_back(step());
    skip_blanks();
    if (!rest_.empty()) fail(text_, fmt::format("goes on with '{}'", rest_));
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      const auto& subscripts = steps[i].subscripts;
      if (std::count(subscripts.begin(), subscripts.end(), std::nullopt) > 0)
        fail(text_, fmt::format("takes all elements of '{}', which has fields", steps[i].name));
    }
    const auto& last = steps.back().subscripts;
    if (!last.empty() && std::count(last.begin(), last.end(), std::nullopt) != 1)
      fail(text_, "does not name a whole row or column: one colon belongs into its last brackets");
    return steps;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }

  bool take(char c) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  MatStep step() {
    skip_blanks();
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_name_character);
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    if (length == 0 || !is_letter(rest_.front())) fail(text_, "lacks the name of a variable");
    MatStep result{std::string(rest_.substr(0, length)), {}};
    rest_.remove_prefix(length);
    if (!take('(')) return result;
    do {
      result.subscripts.push_back(subscript());
    } while (take(','));
    if (!take(')')) fail(text_, "lacks a closing bracket");
    return result;
  }

  std::optional<std::size_t> subscript() {
    if (take(':')) return std::nullopt;
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{} || value == 0) fail(text_, "has a subscript that is no number from 1");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value - 1;
  }

  const std::string& text_;
  std::string_view rest_;
};

}  // namespace

std::vector<MatStep> parse_mat_path(const std::string& text) { return Parser(text).parse(); }

}  // namespace rigcal::datasets
