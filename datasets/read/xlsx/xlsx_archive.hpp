#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// The parts of a workbook, which are the files of a ZIP archive, by libzip.
class XlsxArchive {
 public:
  /// @throws InputError  no archive, damaged, more than 10 000 parts
  explicit XlsxArchive(const std::filesystem::path& path);
  ~XlsxArchive();
  XlsxArchive(const XlsxArchive&) = delete;
  XlsxArchive& operator=(const XlsxArchive&) = delete;

  const std::string& name() const { return name_; }
  bool has(const std::string& part) const;

  /// Passes the inflated bytes of a part to `take`, block by block, until it returns false. At the
  /// end the checksum is verified.
  ///
  /// @throws InputError  no such part, damaged, encrypted, or of more than `most_bytes`
  void read(const std::string& part, std::uint64_t most_bytes,
            const std::function<bool(std::string_view)>& take) const;

 private:
  struct Open;
  std::string name_;
  std::unique_ptr<Open> open_;
};

}  // namespace rigcal::datasets
