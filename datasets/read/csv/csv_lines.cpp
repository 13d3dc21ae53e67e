#include "datasets/read/csv/csv_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <limits>  // csv.h uses it without including it
#include <string>
#include <string_view>
#include <system_error>

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

/// Feeds LineReader, and detects what LineReader would accept: read errors (which it takes for the
/// end), NUL bytes (which cut its lines short), UTF-16, and endless files.
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
    std::size_t count = std::fread(buffer, 1, wanted, file_.get());
    if (std::ferror(file_.get()) != 0) throw InputError(where_, "cannot be read: " + reason(errno));
    check(std::string_view(buffer, count));
    bytes_ += count;
    if (count > 0) ends_with_newline_ = buffer[count - 1] == '\n';
    // If the last line has no line end, LineReader reads one byte too many, from old content of the
    // buffer. Every last line is therefore given a line end.
    if (count < wanted && bytes_ > 0 && !ends_with_newline_) {
      buffer[count++] = '\n';
      ends_with_newline_ = true;
      had_no_last_newline_ = true;
    }
    return static_cast<int>(count);
  }

 private:
  void check(std::string_view block) const {
    if (bytes_ == 0 && (block.substr(0, 2) == "\xFF\xFE" || block.substr(0, 2) == "\xFE\xFF"))
      throw InputError(where_, "is UTF-16 text; expected UTF-8 (save it again as \"CSV UTF-8\")");
    if (const std::size_t at = block.find('\0'); at != std::string_view::npos)
      throw InputError(where_, fmt::format("is a binary file (byte {} is NUL); expected CSV text",
                                           bytes_ + at + 1));
    if (block.size() > max_bytes_ - std::min(max_bytes_, bytes_))
      throw InputError(where_, fmt::format("is longer than the limit of {} bytes; decimate the "
                                           "record, or split it into several files",
                                           max_bytes_));
  }

  Location where_;
  std::size_t max_bytes_;
  FilePtr file_;
  std::size_t bytes_ = 0;
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
