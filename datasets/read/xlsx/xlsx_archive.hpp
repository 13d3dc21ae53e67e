#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// The parts of a workbook, which are files in a ZIP archive, read by libzip.
class XlsxArchive {
 public:
  /// @throws InputError  if the file is not an archive, is damaged, or has more than 10 000 parts
  explicit XlsxArchive(const std::filesystem::path& path);
  ~XlsxArchive();
  XlsxArchive(const XlsxArchive&) = delete;
  XlsxArchive& operator=(const XlsxArchive&) = delete;

  const std::string& name() const { return name_; }
  bool has(const std::string& part) const;

  /// Passes the inflated bytes of a part to `take`, block by block, until `take` returns false.
  /// Verifies the checksum at the end.
  ///
  /// @throws InputError  if there is no such part, or if it is damaged, encrypted, or larger than
  ///                     `most_bytes`
  void read(const std::string& part, std::uint64_t most_bytes,
            const std::function<bool(std::string_view)>& take) const;

 private:
  struct Open;
  std::string name_;
  std::unique_ptr<Open> open_;
};

}  // namespace rigcal::datasets
