#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace rigcal::datasets {

/// The lines of a text file, one at a time, by fast-cpp-csv-parser's LineReader. Its window has at
/// most 48 MB, whatever the size of the file.
class CsvLines {
 public:
  /// @param max_bytes  larger files are refused, at once if the size is known beforehand
  /// @throws InputError  no such file, a folder, unreadable, binary, UTF-16, too large
  CsvLines(const std::filesystem::path& path, std::size_t max_bytes);
  ~CsvLines();
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  /// The next line without its end ("\n" or "\r\n"), null after the last. It may be written to,
  /// and lives until the next call. A byte-order mark is not part of the first line.
  ///
  /// @throws InputError  as the constructor; or the line has 16 MiB or more
  char* next();

  /// Number of the line that next() gave last, from 1.
  long number() const;

  /// Whether the file went to its end without a newline, once next() has given null.
  bool ends_without_newline() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace rigcal::datasets
