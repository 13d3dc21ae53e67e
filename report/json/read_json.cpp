#include "report/json/read_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "common/file.hpp"

namespace rigcal::report {
namespace {

Location place_of_byte(const std::string& file, std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t newline = before.rfind('\n');
  const std::size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
  return {file, 1 + static_cast<long>(std::count(before.begin(), before.end(), '\n')),
          static_cast<long>(byte - line_start) + 1};
}

/// Scans a text once without parsing it, and rejects it if it exceeds a limit. Whether the text is
/// valid JSON is for the parser to decide.
class JsonScan {
 public:
  JsonScan(std::string_view text, const std::string& file, const JsonLimits& limits)
      : text_(text), file_(file), limits_(limits) {}

  void run() {
    for (std::size_t i = 0; i < text_.size();) {
      const char c = text_[i];
      if (c == '"') {
        count_value(i);
        i = end_of_string(i);
      } else if (c == '-' || (c >= '0' && c <= '9')) {
        count_value(i);
        i = end_of_number(i);
      } else {
        if (c == '{' || c == '[') open(i);
        if (c == '}' || c == ']') close();
        if (c == ':') count_key(i);
        ++i;
      }
    }
  }

 private:
  [[noreturn]] void fail(std::size_t byte, const std::string& message) const {
    throw InputError(place_of_byte(file_, text_, byte), message + "; expected a result of rigcal");
  }

  void count_value(std::size_t byte) {
    if (++values_ > limits_.values)
      fail(byte, fmt::format("more than {} values, the limit of a result", limits_.values));
  }

  void open(std::size_t byte) {
    count_value(byte);
    if (keys_.size() == limits_.depth)
      fail(byte, fmt::format("brackets nested more than {} deep", limits_.depth));
    keys_.push_back(0);
  }

  void count_key(std::size_t byte) {
    if (keys_.empty()) return;
    const std::size_t keys = ++keys_.back();
    // This cannot overflow: the size of the text is limited, and a key takes at least three bytes.
    if (comparisons_ + keys * keys > limits_.key_comparisons)
      fail(byte, fmt::format("an object with {} keys, or too many large objects before it", keys));
  }

  void close() {
    if (keys_.empty()) return;
    comparisons_ += keys_.back() * keys_.back();
    keys_.pop_back();
  }

  std::size_t end_of_string(std::size_t begin) const {
    std::size_t i = begin + 1;
    while (i < text_.size() && text_[i] != '"') i += text_[i] == '\\' ? 2 : 1;
    return i + 1;
  }

  std::size_t end_of_number(std::size_t begin) const {
    const std::size_t end =
        std::min(text_.find_first_not_of("+-.0123456789eE", begin), text_.size());
    const std::string_view number = text_.substr(begin, end - begin);
    double value = 0.0;
    const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    const bool too_large = error == std::errc::result_out_of_range
                               ? !is_tiny(number)
                               : std::abs(value) > limits_.number;
    if (too_large) fail(begin, fmt::format("the number {} is too large", number.substr(0, 40)));
    return end;
  }

  /// Returns true if a number outside the range of a double is too small. Such a number is read as
  /// zero.
  static bool is_tiny(std::string_view number) {
    const std::size_t exponent = number.find_first_of("eE");
    if (exponent != std::string_view::npos) return number.substr(exponent + 1).front() == '-';
    return number.find('.') <= 2 && number.find_first_not_of("-0.") != std::string_view::npos;
  }

  std::string_view text_;
  const std::string& file_;
  const JsonLimits& limits_;
  std::vector<std::size_t> keys_;  ///< number of keys so far in each open bracket
  std::size_t values_ = 0;
  std::size_t comparisons_ = 0;
};

}  // namespace

Json parse_json(std::string_view text, const std::string& file, const JsonLimits& limits) {
  if (text.size() > limits.bytes)
    throw InputError({file}, fmt::format("has {} bytes, more than the {} MB of the largest result",
                                         text.size(), limits.bytes >> 20));
  JsonScan(text, file, limits).run();
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError(
        place_of_byte(file, text, std::min(std::max<std::size_t>(error.byte, 1) - 1, text.size())),
        "this is not JSON");
  } catch (const Json::out_of_range&) {
    throw InputError({file}, "contains a number that is too large; expected a result of rigcal");
  }
}

Json read_json(const std::filesystem::path& file, const std::string& expected,
               const JsonLimits& limits) {
  return parse_json(read_file(file, limits.bytes, expected), file.string(), limits);
}

}  // namespace rigcal::report
