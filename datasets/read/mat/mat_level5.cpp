#include "datasets/read/mat/mat_level5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>

#include "common/error.hpp"
#include "common/file.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::uint64_t kHeaderBytes = 128;
constexpr std::uint64_t kTagBytes = 8;
constexpr std::size_t kMostArrays = 200'000;
constexpr std::uint64_t kMostDims = 32;
constexpr std::uint64_t kMostNameBytes = 4096;
constexpr std::uint64_t kMostFieldNameBytes = 1 << 20;
constexpr int kMostStructDepth = 32;

/// Data types, from table 1-1 of the format.
enum MatStorage : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kSingle = 7,
  kDouble = 9,
  kInt64 = 12,
  kUint64 = 13,
  kMatrix = 14,
  kCompressed = 15,
  kUtf8 = 16
};

/// Array classes, from table 1-3, and later additions.
enum MatClass : std::uint32_t {
  kCell = 1,
  kStruct = 2,
  kObject = 3,
  kChar = 4,
  kSparse = 5,
  kDoubleClass = 6,
  kUint64Class = 15,
  kFunction = 16,
  kOpaque = 17
};

constexpr std::uint32_t kComplexFlag = 0x0800;

/// Bytes per number; 0 for types that are not numeric.
std::size_t bytes_of(std::uint32_t storage) {
  switch (storage) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kSingle:
      return 4;
    case kDouble:
    case kInt64:
    case kUint64:
      return 8;
    default:
      return 0;
  }
}

template <typename Number>
Number swapped_bytes(Number value) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(Number));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&value, bytes.data(), sizeof(Number));
  return value;
}

/// A data element: its type, and the position of its data in the stream.
struct DataElement {
  std::uint32_t type = 0;
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
  std::uint64_t next = 0;             ///< start of the next element
  std::array<char, 4> held_in_tag{};  ///< the data, if the tag contains them
  bool is_held_in_tag = false;
};

/// Parses one variable.
class Level5Parser {
 public:
  Level5Parser(ByteStream& stream, bool swapped, std::size_t variable, std::size_t& arrays)
      : stream_(stream), swapped_(swapped), variable_(variable), arrays_(arrays) {}

  /// Parses the array whose tag has been read.
  ///
  /// @param end  position at which the array ends
  MatArray array(std::uint64_t end, int depth) {
    if (++arrays_ > kMostArrays)
      throw DamagedBytes(fmt::format("more than {} arrays in the file", kMostArrays));
    MatArray array;
    array.variable = variable_;
    if (stream_.position() == end) return array;  // MATLAB writes an empty field like this
    const DataElement flags_at = element(end);
    if (flags_at.type != kUint32 || flags_at.bytes != 8)
      throw DamagedBytes("an array without its flags");
    const std::uint32_t flags = words<std::uint32_t>(flags_at).front();
    const std::uint32_t type = flags & 0xFFU;
    array.is_complex = (flags & kComplexFlag) != 0;
    array.kind = kind_of(type);
    if (type != kOpaque) array.dims = dims(end);
    array.name = checked_name(text(element(end), kMostNameBytes));
    if (array.kind == MatKind::structure) {
      fields(array, end, depth);
    } else if (array.kind == MatKind::number) {
      numbers(array, end);
    }
    if (stream_.position() > end) throw DamagedBytes("an array that is longer than stated");
    if (array.kind == MatKind::structure || array.kind == MatKind::number) {
      if (stream_.position() != end) throw DamagedBytes("an array that is shorter than stated");
    }
    skip_to(end);
    return array;
  }

  /// Reads the tag at the stream's position.
  DataElement element(std::uint64_t end) {
    const std::uint64_t begin = stream_.position();
    if (end < begin + kTagBytes) throw DamagedBytes("an element that ends within its tag");
    std::array<char, kTagBytes> raw;
    stream_.read(raw.data(), raw.size());
    const auto first = word(raw.data());
    DataElement element;
    if (first >> 16U != 0) {
      element.type = first & 0xFFFFU;
      element.bytes = first >> 16U;
      element.begin = begin + 4;
      element.next = begin + kTagBytes;
      element.is_held_in_tag = true;
      if (element.bytes > element.held_in_tag.size())
        throw DamagedBytes("an element with more bytes than its tag allows");
      std::copy(raw.begin() + 4, raw.end(), element.held_in_tag.begin());
      return element;
    }
    element.type = first;
    element.bytes = word(raw.data() + 4);
    element.begin = begin + kTagBytes;
    if (element.bytes > end - element.begin)
      throw DamagedBytes("an element that is longer than its container");
    // Elements begin at multiples of eight bytes; some writers omit the padding after the last one.
    element.next = std::min(end, element.begin + (element.bytes + 7) / 8 * 8);
    return element;
  }

 private:
  static MatKind kind_of(std::uint32_t type) {
    if (type >= kDoubleClass && type <= kUint64Class) return MatKind::number;
    switch (type) {
      case kCell:
        return MatKind::cell;
      case kStruct:
        return MatKind::structure;
      case kChar:
        return MatKind::text;
      case kSparse:
        return MatKind::sparse;
      case kFunction:
        return MatKind::function;
      case kObject:
      case kOpaque:
        return MatKind::object;
      default:
        throw DamagedBytes(fmt::format("an array of the unknown class {}", type));
    }
  }

  std::uint32_t word(const char* bytes) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, sizeof(value));
    return swapped_ ? swapped_bytes(value) : value;
  }

  void skip_to(std::uint64_t position) {
    if (position > stream_.position()) stream_.skip(position - stream_.position());
  }

  /// Reads an element and its padding.
  std::string content(const DataElement& element, std::uint64_t most_bytes) {
    if (element.bytes > most_bytes)
      throw DamagedBytes(fmt::format("a description of {} bytes", element.bytes));
    const auto bytes = static_cast<std::size_t>(element.bytes);
    if (element.is_held_in_tag) return {element.held_in_tag.data(), bytes};
    std::string result(bytes, '\0');
    stream_.read(result.data(), result.size());
    skip_to(element.next);
    return result;
  }

  /// Reads a name, or a list of field names padded with NULs, without checking it.
  std::string text(const DataElement& element, std::uint64_t most_bytes) {
    if (element.type != kInt8 && element.type != kUint8 && element.type != kUtf8)
      throw DamagedBytes("a name that is not text");
    return content(element, most_bytes);
  }

  static std::string checked_name(std::string_view name) {
    const auto is_control = [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    };
    if (std::any_of(name.begin(), name.end(), is_control))
      throw DamagedBytes("a name with a byte that is not a character");
    return std::string(name);
  }

  template <typename Word>
  std::vector<Word> words(const DataElement& element) {
    const std::string bytes = content(element, kMostDims * sizeof(Word));
    std::vector<Word> result(bytes.size() / sizeof(Word));
    std::memcpy(result.data(), bytes.data(), result.size() * sizeof(Word));
    if (swapped_) std::transform(result.begin(), result.end(), result.begin(), swapped_bytes<Word>);
    return result;
  }

  std::vector<std::size_t> dims(std::uint64_t end) {
    const DataElement at = element(end);
    if (at.type != kInt32 || at.bytes < 8 || at.bytes % 4 != 0)
      throw DamagedBytes("an array without its dimensions");
    std::vector<std::size_t> result;
    // A file cannot have more bytes than this, even for a sparse array or a text.
    constexpr std::size_t kMostElements = std::numeric_limits<std::int64_t>::max();
    std::size_t count = 1;
    for (const std::int32_t n : words<std::int32_t>(at)) {
      if (n < 0) throw DamagedBytes("a dimension below zero");
      const auto size = static_cast<std::size_t>(n);
      if (size > 0 && count > kMostElements / size)
        throw DamagedBytes("dimensions too large for any file");
      count *= size;
      result.push_back(size);
    }
    return result;
  }

  void fields(MatArray& array, std::uint64_t end, int depth) {
    if (depth == kMostStructDepth)
      throw DamagedBytes(fmt::format("structs nested more than {} deep", kMostStructDepth));
    const DataElement length_at = element(end);
    if (length_at.type != kInt32 || length_at.bytes != 4)
      throw DamagedBytes("a struct without the length of its field names");
    const std::int32_t length = words<std::int32_t>(length_at).front();
    const std::string names = text(element(end), kMostFieldNameBytes);
    if (length <= 0 || names.size() % static_cast<std::size_t>(length) != 0)
      throw DamagedBytes("a struct whose field names do not fit their length");
    for (std::size_t at = 0; at < names.size(); at += static_cast<std::size_t>(length)) {
      const std::string_view name =
          std::string_view(names).substr(at, static_cast<std::size_t>(length));
      array.field_names.push_back(checked_name(name.substr(0, name.find('\0'))));
    }
    if (array.field_names.empty()) return;
    const std::size_t elements = array.element_count();
    // Each field takes at least one tag.
    const std::uint64_t most = (end - stream_.position()) / kTagBytes;
    if (elements > most / array.field_names.size())
      throw DamagedBytes("a struct with more fields than its data can contain");
    for (std::size_t i = 0; i < elements * array.field_names.size(); ++i) {
      const DataElement field = element(end);
      if (field.type != kMatrix || field.is_held_in_tag)
        throw DamagedBytes("a field that is not an array");
      array.fields.push_back(this->array(field.begin + field.bytes, depth + 1));
      skip_to(field.next);
    }
  }

  void numbers(MatArray& array, std::uint64_t end) {
    for (int part = 0; part < (array.is_complex ? 2 : 1); ++part) {
      const DataElement data = element(end);
      const std::size_t size = bytes_of(data.type);
      if (size == 0) throw DamagedBytes("an array of numbers without numbers");
      if (data.bytes % size != 0 || data.bytes / size != array.element_count())
        throw DamagedBytes("an array whose number of values does not match its dimensions");
      if (part == 0) {
        array.place = data.begin;
        array.storage = data.type;
      }
      skip_to(data.next);
    }
  }

  ByteStream& stream_;
  bool swapped_;
  std::size_t variable_;
  std::size_t& arrays_;
};

template <typename Number>
std::vector<double> selected(ByteStream& stream, bool swapped, const MatSelection& selection,
                             const std::string& file, const std::string& column) {
  constexpr std::size_t kBlock = 8192;
  std::vector<Number> block;
  std::vector<double> values;
  values.reserve(selection.count);
  std::size_t left = selection.count == 0 ? 0 : (selection.count - 1) * selection.stride + 1;
  std::size_t next = 0;  // index of the next wanted number in the block
  while (left > 0) {
    block.resize(std::min(left, kBlock));
    stream.read(block.data(), block.size() * sizeof(Number));
    for (; next < block.size(); next += selection.stride) {
      const Number number = swapped ? swapped_bytes(block[next]) : block[next];
      values.push_back(static_cast<double>(number));
      if (!is_exact_as_double(number))
        throw InputError({file},
                         fmt::format("element {} of '{}' is {}, more than a double can hold "
                                     "exactly",
                                     values.size(), column, number));
    }
    next -= block.size();
    left -= block.size();
  }
  return values;
}

}  // namespace

Level5Source::Level5Source(const std::filesystem::path& path, std::uint64_t most_inflated_bytes)
    : name_(path.string()), most_inflated_bytes_(most_inflated_bytes) {
  require_regular_file(path, "a MAT file");
  file_.open(path, std::ios::binary);
  file_.seekg(0, std::ios::end);
  const auto file_bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(0, file_.tellg()));
  file_.seekg(0);
  std::array<char, kHeaderBytes> header{};
  if (!file_.read(header.data(), header.size()))
    throw InputError({name_}, "is shorter than the header of a MAT file: it is truncated");
  const std::string_view order(header.data() + 126, 2);
  if (order != "IM" && order != "MI")
    throw InputError({name_}, "is damaged: its header does not give the order of the bytes");
  swapped_ = order == "MI";
  for (std::uint64_t at = kHeaderBytes; at < file_bytes;) {
    const std::size_t number = ranges_.size() + 1;
    try {
      FileBytes stream(file_, at, file_bytes - at);
      std::size_t unused = 0;
      const DataElement tag = Level5Parser(stream, swapped_, 0, unused).element(file_bytes - at);
      if ((tag.type != kMatrix && tag.type != kCompressed) || tag.is_held_in_tag)
        throw DamagedBytes(
            fmt::format("its data type is {}, which is not that of a variable", tag.type));
      const Range range{at + kTagBytes, tag.bytes, tag.type == kCompressed};
      read_variable(range);
      at = range.begin + range.bytes;
    } catch (const DamagedBytes& damage) {
      throw InputError({name_}, fmt::format("is truncated or damaged in variable {}, which begins "
                                            "at byte {} ({}); copy or save it again",
                                            number, at + 1, damage.what()));
    }
  }
  if (variables_.empty()) throw InputError({name_}, "contains no variables; expected at least one");
}

std::unique_ptr<ByteStream> Level5Source::open(const Range& range) {
  if (range.compressed) return std::make_unique<InflatedBytes>(file_, range.begin, range.bytes);
  return std::make_unique<FileBytes>(file_, range.begin, range.bytes);
}

void Level5Source::read_variable(const Range& range) {
  const std::unique_ptr<ByteStream> stream = open(range);
  Level5Parser parser(*stream, swapped_, ranges_.size(), arrays_);
  std::uint64_t end = range.bytes;
  if (range.compressed) {
    const DataElement tag = parser.element(std::numeric_limits<std::uint32_t>::max());
    if (tag.type != kMatrix || tag.is_held_in_tag)
      throw DamagedBytes("compressed data that are not an array");
    end = tag.begin + tag.bytes;
    inflated_bytes_ += end;
    if (inflated_bytes_ > most_inflated_bytes_)
      throw DamagedBytes(
          fmt::format("compressed variables of more than {} MB", most_inflated_bytes_ >> 20));
  }
  variables_.push_back(parser.array(end, 0));
  ranges_.push_back(range);
  stream->finish();
}

std::vector<double> Level5Source::numbers(const MatArray& array, const MatSelection& selection,
                                          const std::string& column) {
  const std::uint64_t begin = array.place + selection.start * bytes_of(array.storage);
  try {
    if (!stream_ || stream_of_ != array.variable || stream_->position() > begin) {
      stream_ = open(ranges_.at(array.variable));
      stream_of_ = array.variable;
    }
    stream_->skip(begin - stream_->position());
    const auto read = [&](auto zero) {
      return selected<decltype(zero)>(*stream_, swapped_, selection, name_, column);
    };
    switch (array.storage) {
      case kInt8:
        return read(std::int8_t{});
      case kUint8:
        return read(std::uint8_t{});
      case kInt16:
        return read(std::int16_t{});
      case kUint16:
        return read(std::uint16_t{});
      case kInt32:
        return read(std::int32_t{});
      case kUint32:
        return read(std::uint32_t{});
      case kInt64:
        return read(std::int64_t{});
      case kUint64:
        return read(std::uint64_t{});
      case kSingle:
        return read(float{});
      default:
        return read(double{});
    }
  } catch (const DamagedBytes& damage) {
    throw InputError({name_}, fmt::format("'{}' cannot be read ({}): the file is damaged, or was "
                                          "changed meanwhile",
                                          column, damage.what()));
  }
}

}  // namespace rigcal::datasets
