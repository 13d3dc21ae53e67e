#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace rigcal::datasets {

/// Reads the lines of a text file one at a time, using the LineReader of fast-cpp-csv-parser. Its
/// buffer has at most 48 MB, whatever the size of the file. UTF-16, as Excel writes "Unicode text",
/// is converted to UTF-8.
class CsvLines {
 public:
  /// @param max_bytes  larger files are refused, immediately if the size is known in advance
  /// @throws InputError  if there is no such file, or if it is a folder, unreadable, binary or
  ///                     too large
  CsvLines(const std::filesystem::path& path, std::size_t max_bytes);
  ~CsvLines();
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  /// Returns the next line without its end ("\n" or "\r\n"), or null after the last. The caller may
  /// modify the line, which remains valid until the next call. A byte-order mark is not part of the
  /// first line.
  ///
  /// @throws InputError  under the conditions of the constructor, or if the line has 16 MiB or more
  char* next();

  /// Returns the number of the line that next() last returned, from 1.
  long number() const;

  /// Whether the file ended without a newline; known once next() has returned null.
  bool ends_without_newline() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace rigcal::datasets
