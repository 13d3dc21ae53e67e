#include "datasets/read/mat/mat_level5.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "datasets/read/mat/load_mat.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/support/temporary_folder.hpp"

// Builds files byte by byte, following "MAT-File Format" by The MathWorks.

namespace rigcal::test {
namespace {

using Catch::Contains;
using datasets::Level5Source;
using datasets::load_mat_record;

struct Level5Writer {
  bool big_endian = false;

  template <typename Number>
  std::string raw(Number value) const {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Number));
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }
  template <typename Number>
  std::string raw_list(const std::vector<Number>& values) const {
    std::string bytes;
    for (const Number value : values) bytes += raw(value);
    return bytes;
  }
  std::string tag(std::uint32_t type, std::size_t bytes) const {
    return raw(type) + raw(static_cast<std::uint32_t>(bytes));
  }
  /// Returns an element with its data padded to a multiple of eight bytes.
  std::string element(std::uint32_t type, std::string data) const {
    const std::string head = tag(type, data.size());
    data.resize((data.size() + 7) / 8 * 8, '\0');
    return head + data;
  }
  /// Returns an element with up to four bytes of data within its tag.
  std::string small_element(std::uint32_t type, std::string data) const {
    const auto size = static_cast<std::uint32_t>(data.size());
    data.resize(4, '\0');
    return raw(type | size << 16U) + data;
  }
  std::string array_head(std::uint32_t type, const std::vector<std::int32_t>& dims,
                         const std::string& name) const {
    return element(6, raw(type) + raw(std::uint32_t{0})) + element(5, raw_list(dims)) +
           element(1, name);
  }
  /// @param data  the element that contains the numbers
  std::string numbers(const std::string& name, const std::vector<std::int32_t>& dims,
                      const std::string& data) const {
    return element(14, array_head(6, dims, name) + data);
  }
  std::string file(const std::string& variables) const {
    std::string header = "MATLAB 5.0 MAT-file";
    header.resize(124, ' ');
    return header + raw(std::uint16_t{0x0100}) + raw(std::uint16_t{0x4D49}) + variables;
  }
};

std::string deflated(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string result(size, '\0');
  REQUIRE(::compress(reinterpret_cast<Bytef*>(result.data()), &size,
                     reinterpret_cast<const Bytef*>(text.data()),
                     static_cast<uLong>(text.size())) == Z_OK);
  result.resize(size);
  return result;
}

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  return message_when([&] { load_mat_record(folder.write("a.mat", content), {{"x"}, ""}); });
}

const Level5Writer kLittle{};

}  // namespace

TEST_CASE("level 5: either order of bytes, every type that stores numbers", "[datasets]") {
  const Level5Writer writer{GENERATE(false, true)};
  const std::vector<std::string> stored{
      writer.element(1, writer.raw_list(std::vector<std::int8_t>{1, 2, 100})),
      writer.small_element(2, writer.raw_list(std::vector<std::uint8_t>{1, 2, 100})),
      writer.element(3, writer.raw_list(std::vector<std::int16_t>{1, 2, 100})),
      writer.element(4, writer.raw_list(std::vector<std::uint16_t>{1, 2, 100})),
      writer.element(5, writer.raw_list(std::vector<std::int32_t>{1, 2, 100})),
      writer.element(6, writer.raw_list(std::vector<std::uint32_t>{1, 2, 100})),
      writer.element(7, writer.raw_list(std::vector<float>{1, 2, 100})),
      writer.element(9, writer.raw_list(std::vector<double>{1, 2, 100})),
      writer.element(12, writer.raw_list(std::vector<std::int64_t>{1, 2, 100})),
      writer.element(13, writer.raw_list(std::vector<std::uint64_t>{1, 2, 100}))};
  const TemporaryFolder folder;
  for (const std::string& data : stored) {
    const auto path = folder.write("a.mat", writer.file(writer.numbers("x", {1, 3}, data)));
    CHECK(load_mat_record(path, {{"x"}, ""}).columns[0] == std::vector<double>{1, 2, 100});
  }
}

TEST_CASE("level 5: an integer that a double cannot hold, at the limit", "[datasets]") {
  const auto read = [](std::int64_t value) {
    return refusal(
        kLittle.file(kLittle.numbers("x", {1, 1}, kLittle.element(12, kLittle.raw(value)))));
  };
  constexpr std::int64_t kMost = std::int64_t{1} << 53;
  CHECK(read(kMost) == "no error");
  CHECK(read(-kMost) == "no error");
  CHECK_THAT(read(kMost + 1), Contains("is 9007199254740993, more than a double can hold"));
  CHECK_THAT(read(-kMost - 1), Contains("is -9007199254740993, more than"));
}

TEST_CASE("level 5: rows and planes of larger arrays, across blocks of reading", "[datasets]") {
  const TemporaryFolder folder;
  constexpr int kColumns = 30'000;
  std::vector<double> values;
  for (int i = 0; i < 3 * kColumns; ++i) values.push_back(i);
  const std::string variable =
      kLittle.numbers("x", {3, kColumns}, kLittle.element(9, kLittle.raw_list(values)));
  const std::string packed = deflated(variable);
  for (const std::string& content : {variable, kLittle.tag(15, packed.size()) + packed}) {
    const auto path = folder.write("a.mat", kLittle.file(content));
    const auto table = load_mat_record(path, {{"x(2,:)", "x(3,:)", "x(1,:)"}, ""}).columns;
    for (const std::size_t row : {0U, 1U, 2U}) {
      const auto& line = table[row];
      const double first = std::array{1.0, 2.0, 0.0}[row];
      REQUIRE(line.size() == kColumns);
      bool right = true;
      for (std::size_t i = 0; i < line.size(); ++i)
        right = right && line[i] == first + 3.0 * static_cast<double>(i);
      CHECK(right);
    }
  }
}

TEST_CASE("level 5: nothing that a file says of itself is believed", "[datasets]") {
  const std::string three = kLittle.element(9, kLittle.raw_list(std::vector<double>{1, 2, 3}));
  const std::string good = kLittle.numbers("x", {1, 3}, three);
  REQUIRE(refusal(kLittle.file(good)) == "no error");
  const auto nested = [](int depth) {
    std::string inner = kLittle.tag(14, 0);
    for (int i = 0; i < depth; ++i)
      inner =
          kLittle.element(14, kLittle.array_head(2, {1, 1}, i + 1 == depth ? "x" : "") +
                                  kLittle.small_element(5, kLittle.raw(std::int32_t{8})) +
                                  kLittle.element(1, std::string("f\0\0\0\0\0\0\0", 8)) + inner);
    return inner;
  };
  const auto structure = [](const std::vector<std::int32_t>& dims, std::int32_t length,
                            const std::string& names, const std::string& fields) {
    return kLittle.element(14, kLittle.array_head(2, dims, "x") +
                                   kLittle.small_element(5, kLittle.raw(length)) +
                                   kLittle.element(1, names) + fields);
  };
  const std::string eight_zeros(8, '\0');
  const std::string bomb =
      deflated(kLittle.tag(14, 4'000'000'000U) + kLittle.array_head(4, {1, 1}, "x") +
               std::string(1 << 20, '\0'));
  constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();
  struct Case {
    std::string variables, word;
  };
  const std::vector<Case> cases{
      {kLittle.tag(14, 0xFFFFFFF0U) + eight_zeros, "longer than its container"},
      {kLittle.tag(9, 8) + eight_zeros, "which is not that of a variable"},
      {kLittle.raw(std::uint32_t{14} | 4U << 16U) + "abcd", "which is not that of a variable"},
      {kLittle.numbers("x", {1, 2}, three), "does not match its dimensions"},
      {kLittle.numbers("x", {1, 4}, three), "does not match its dimensions"},
      {kLittle.numbers("x", {1, 5}, kLittle.raw(std::uint32_t{2} | 5U << 16U) + "abcd"),
       "more bytes than its tag allows"},
      {kLittle.element(14,
                       kLittle.array_head(6, {1, 4}, "x") + kLittle.tag(9, 32) + three.substr(8)),
       "longer than its container"},
      {kLittle.numbers("x", {kLargest, kLargest, kLargest}, three), "too large for any file"},
      {kLittle.numbers("x", {-1, 3}, three), "below zero"},
      {kLittle.numbers("x", std::vector<std::int32_t>(40, 1), three), "description of 160 bytes"},
      {kLittle.numbers("x", {3}, three), "without its dimensions"},
      {kLittle.numbers("x", {1, 3}, three + eight_zeros), "shorter than stated"},
      {kLittle.numbers(std::string(5000, 'x'), {1, 3}, three), "description of 5000 bytes"},
      {kLittle.numbers("x\n", {1, 3}, three), "not a character"},
      {kLittle.element(14, kLittle.array_head(99, {1, 3}, "x") + three), "unknown class 99"},
      {kLittle.element(14, kLittle.array_head(6, {1, 3}, "x") + kLittle.element(16, "abc")),
       "without numbers"},
      {structure({1, 1}, 0, eight_zeros, ""), "do not fit their length"},
      {structure({1, 1}, -8, eight_zeros, ""), "do not fit their length"},
      {structure({1, 1}, 3, eight_zeros, ""), "do not fit their length"},
      {structure({kLargest, 1}, 8, "f" + std::string(7, '\0'), ""), "than its data can contain"},
      {structure({100, 1}, 8, "f" + std::string(7, '\0'), kLittle.tag(14, 0)),
       "than its data can contain"},
      {structure({1, 1}, 8, "f" + std::string(7, '\0'), kLittle.element(9, eight_zeros)),
       "a field that is not an array"},
      {nested(40), "structs nested more than"},
      {kLittle.tag(15, bomb.size()) + bomb, "its data end early"},
      {kLittle.tag(15, 20) + std::string(20, 'x'), "incorrect header check"},
  };
  for (const Case& each : cases) {
    const std::string message = refusal(kLittle.file(each.variables));
    CHECK_THAT(message,
               Contains("damaged in variable 1, which begins at byte 129") && Contains(each.word));
    // The preceding content does not matter.
    CHECK_THAT(refusal(kLittle.file(good + each.variables)), Contains("damaged in variable 2"));
  }
  CHECK_THAT(refusal(kLittle.file(nested(20))), Contains("'x' is a struct"));
}

TEST_CASE("level 5: what fills up the last element may be missing", "[datasets]") {
  const std::string array = kLittle.array_head(6, {1, 3}, "x") + kLittle.tag(1, 3) + "\1\2\3";
  CHECK(refusal(kLittle.file(kLittle.tag(14, array.size()) + array)) == "no error");
}

TEST_CASE("level 5: compressed data end where their array does", "[datasets]") {
  const std::string three = kLittle.element(9, kLittle.raw_list(std::vector<double>{1, 2, 3}));
  const std::string good = kLittle.numbers("x", {1, 3}, three);
  const auto compressed = [](const std::string& data) {
    return kLittle.file(kLittle.tag(15, data.size()) + data);
  };
  CHECK(refusal(compressed(deflated(good))) == "no error");
  CHECK_THAT(refusal(compressed(deflated(good + "more"))), Contains("end before the file does"));
  CHECK_THAT(refusal(compressed(deflated(good) + "more")), Contains("more follows"));
  std::string wrong_sum = deflated(good);
  wrong_sum.back() = static_cast<char>(wrong_sum.back() ^ 1);
  CHECK_THAT(refusal(compressed(wrong_sum)), Contains("incorrect data check"));
}

TEST_CASE("level 5: what compressed variables inflate to is limited", "[datasets]") {
  const std::string zeros(1 << 20, '\0');
  const std::string variable =
      deflated(kLittle.element(14, kLittle.array_head(4, {1, 1}, "zeros") + zeros));
  std::string all;
  for (int i = 0; i < 10; ++i) all += kLittle.tag(15, variable.size()) + variable;
  const TemporaryFolder folder;
  const auto path = folder.write("a.mat", kLittle.file(all));
  CHECK_NOTHROW(Level5Source(path, std::uint64_t{11} << 20));
  CHECK_THROWS_WITH(Level5Source(path, std::uint64_t{10} << 20),
                    Contains("damaged in variable 10") && Contains("more than 10 MB"));
}

}  // namespace rigcal::test
