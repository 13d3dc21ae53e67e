#include "datasets/read/csv/csv_lines.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <limits>  // csv.h uses it without including it
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

// A second thread would not be faster, and would have to pass on exceptions from the source.
#define CSV_IO_NO_THREAD
// The library truncates its file names to 255 bytes on purpose.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#endif
#include <libfccp/csv.h>

#include "common/error.hpp"

namespace rigcal::datasets {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePtr = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

FilePtr open_text(const std::filesystem::path& path, std::size_t max_bytes) {
  const Location where{path.string()};
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(where, "is a folder; expected a CSV file");
  const auto bytes = std::filesystem::file_size(path, error);  // fails for pipes: counted later
  if (!error && bytes > max_bytes)
    throw InputError(where, fmt::format("has {} bytes, more than the limit of {}; decimate the "
                                        "record, or split it into several files",
                                        bytes, max_bytes));
  FilePtr file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(where, "cannot be opened: " + reason(errno));
  std::setvbuf(file.get(), nullptr, _IONBF, 0);  // LineReader already reads blocks of megabytes
  return file;
}

/// Returns the name of the UTF-16 in which a file begins; empty for other text. A byte-order mark
/// says which it is. Without one, every second byte of ASCII is NUL.
std::string utf16_of(std::string_view start) {
  if (start.starts_with("\xFF\xFE")) return "UTF-16LE";
  if (start.starts_with("\xFE\xFF")) return "UTF-16BE";
  if (start.size() < 4) return {};
  const auto is_nul = [&start](std::size_t i) { return start[i] == '\0'; };
  if (!is_nul(0) && is_nul(1) && !is_nul(2) && is_nul(3)) return "UTF-16LE";
  if (is_nul(0) && !is_nul(1) && is_nul(2) && !is_nul(3)) return "UTF-16BE";
  return {};
}

/// Converts UTF-16 to UTF-8 block by block, by iconv of the C library.
class Utf16Decoder {
 public:
  Utf16Decoder(const std::string& encoding, Location where)
      : converter_(iconv_open("UTF-8", encoding.c_str())), where_(std::move(where)) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): how POSIX defines the failure of iconv_open()
    if (converter_ == reinterpret_cast<iconv_t>(-1))
      throw InputError(where_, "is " + encoding +
                                   " text, which the C library cannot convert; "
                                   "save it again as \"CSV UTF-8\"");
  }
  ~Utf16Decoder() { iconv_close(converter_); }
  Utf16Decoder(const Utf16Decoder&) = delete;
  Utf16Decoder& operator=(const Utf16Decoder&) = delete;

  /// Replaces `bytes` by the UTF-8 of its whole characters, and keeps the rest for the next call.
  void convert(std::string& bytes, bool is_last) {
    pending_ += bytes;
    bytes.clear();
    char* in = pending_.data();
    std::size_t left = pending_.size();
    std::array<char, std::size_t{1} << 16> converted;
    while (left > 0) {
      char* out = converted.data();
      std::size_t room = converted.size();
      const std::size_t result = iconv(converter_, &in, &left, &out, &room);
      const int error = errno;
      bytes.append(converted.data(), converted.size() - room);
      if (result != static_cast<std::size_t>(-1) || error == E2BIG) continue;
      if (error == EINVAL && !is_last) break;  // the next block has the rest of the character
      throw InputError(where_, fmt::format("is UTF-16 text, but byte {} belongs to no character; "
                                           "save it again as \"CSV UTF-8\"",
                                           taken_ + pending_.size() - left + 1));
    }
    taken_ += pending_.size() - left;
    pending_.erase(0, pending_.size() - left);
  }

 private:
  iconv_t converter_;
  Location where_;
  std::string pending_;    ///< bytes that are not converted yet
  std::size_t taken_ = 0;  ///< bytes before them
};

/// Feeds LineReader, and detects what LineReader would accept: read errors (which it takes for the
/// end), NUL bytes (which cut its lines short), and endless files. UTF-16 becomes UTF-8.
class TextSource : public io::ByteSourceBase {
 public:
  /// @param had_no_last_newline  set by the time the last line is read; must outlive the source
  TextSource(const std::filesystem::path& path, std::size_t max_bytes, bool& had_no_last_newline)
      : where_{path.string()},
        max_bytes_(max_bytes),
        file_(open_text(path, max_bytes)),
        had_no_last_newline_(had_no_last_newline) {}

  int read(char* buffer, int size) override {
    const std::size_t wanted = static_cast<std::size_t>(size);
    std::size_t count = given_ == 0 ? start(buffer, wanted) : more(buffer, wanted);
    check(std::string_view(buffer, count));
    given_ += count;
    if (count > 0) ends_with_newline_ = buffer[count - 1] == '\n';
    // If the last line has no line end, LineReader reads one byte too many, from old content of the
    // buffer. Every last line is therefore given a line end.
    if (count < wanted && given_ > 0 && !ends_with_newline_) {
      buffer[count++] = '\n';
      ends_with_newline_ = true;
      had_no_last_newline_ = true;
    }
    return static_cast<int>(count);
  }

 private:
  /// Reads bytes of the file as they are.
  std::size_t raw(char* buffer, std::size_t wanted) {
    const std::size_t count = std::fread(buffer, 1, wanted, file_.get());
    if (std::ferror(file_.get()) != 0) throw InputError(where_, "cannot be read: " + reason(errno));
    if (count > max_bytes_ - std::min(max_bytes_, bytes_))
      throw InputError(where_, fmt::format("is longer than the limit of {} bytes; decimate the "
                                           "record, or split it into several files",
                                           max_bytes_));
    bytes_ += count;
    return count;
  }

  /// Reads the first bytes, which show the encoding.
  std::size_t start(char* buffer, std::size_t wanted) {
    const std::size_t count = raw(buffer, wanted);
    const std::string encoding = utf16_of({buffer, count});
    if (encoding.empty()) return count;
    decoder_ = std::make_unique<Utf16Decoder>(encoding, where_);
    ended_ = count < wanted;
    decoded_.assign(buffer, count);
    decoder_->convert(decoded_, ended_);
    return more(buffer, wanted);
  }

  /// Reads further text, which is shorter than `wanted` only at the end of the file.
  std::size_t more(char* buffer, std::size_t wanted) {
    if (!decoder_) return raw(buffer, wanted);
    while (decoded_.size() < wanted && !ended_) {
      std::string block(wanted, '\0');
      block.resize(raw(block.data(), wanted));
      ended_ = block.size() < wanted;
      decoder_->convert(block, ended_);
      decoded_ += block;
    }
    const std::size_t count = std::min(wanted, decoded_.size());
    std::copy_n(decoded_.begin(), count, buffer);
    decoded_.erase(0, count);
    return count;
  }

  void check(std::string_view block) const {
    if (const std::size_t at = block.find('\0'); at != std::string_view::npos)
      throw InputError(where_, fmt::format("is a binary file (byte {} is NUL); expected CSV text",
                                           given_ + at + 1));
  }

  Location where_;
  std::size_t max_bytes_;
  FilePtr file_;
  std::unique_ptr<Utf16Decoder> decoder_;  ///< null unless the file is UTF-16
  std::string decoded_;                    ///< text that LineReader has not asked for yet
  bool ended_ = false;                     ///< whether the decoder has the whole file
  std::size_t bytes_ = 0;                  ///< read from the file
  std::size_t given_ = 0;                  ///< given to LineReader
  bool ends_with_newline_ = false;
  bool& had_no_last_newline_;
};

}  // namespace

struct CsvLines::Implementation {
  Implementation(const std::filesystem::path& path, std::size_t max_bytes)
      : file(path.string()),
        reader(file, std::make_unique<TextSource>(path, max_bytes, had_no_last_newline)) {}
  std::string file;
  bool had_no_last_newline = false;  ///< here because the reader drops its source at the end
  io::LineReader reader;
};

CsvLines::CsvLines(const std::filesystem::path& path, std::size_t max_bytes)
    : implementation_(std::make_unique<Implementation>(path, max_bytes)) {}

CsvLines::~CsvLines() = default;

char* CsvLines::next() {
  try {
    return implementation_->reader.next_line();
  } catch (const io::error::line_length_limit_exceeded&) {
    throw InputError({implementation_->file, number(), 0},
                     "the line has 16 MiB or more; expected one row of numbers per line");
  }
}

long CsvLines::number() const { return static_cast<long>(implementation_->reader.get_file_line()); }

bool CsvLines::ends_without_newline() const { return implementation_->had_no_last_newline; }

}  // namespace rigcal::datasets
