#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace rigcal::datasets {

/// Thrown for damaged bytes; what() describes the damage in words.
class DamagedBytes : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A stream of bytes that is read in order.
class ByteStream {
 public:
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// Returns the number of bytes that were read or skipped.
  std::uint64_t position() const { return position_; }

  /// @throws DamagedBytes  if fewer bytes are left
  void read(void* to, std::size_t bytes);
  virtual void skip(std::uint64_t bytes);

  /// Checks that the stream ends here.
  /// @throws DamagedBytes  if more bytes follow, or if the stream detects damage
  virtual void finish() = 0;

  /// Reads up to `bytes` bytes and returns their number, which is 0 only at the end.
  virtual std::size_t next(char* to, std::size_t bytes) = 0;

 protected:
  void advance(std::uint64_t bytes) { position_ += bytes; }

 private:
  std::uint64_t position_ = 0;
};

/// A range of a file. Only one may be in use per file at a time, because it moves the file's
/// position.
class FileBytes : public ByteStream {
 public:
  FileBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes);
  std::size_t next(char* to, std::size_t bytes) override;
  /// Moves on without reading the skipped bytes.
  void skip(std::uint64_t bytes) override;
  void finish() override;

 private:
  std::ifstream& file_;
  std::uint64_t left_;
};

/// Bytes inflated from a compressed range of a file.
class InflatedBytes : public ByteStream {
 public:
  InflatedBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes);
  ~InflatedBytes() override;
  std::size_t next(char* to, std::size_t bytes) override;
  /// Also verifies the checksum, and checks that nothing follows the compressed data.
  void finish() override;

 private:
  FileBytes file_;
  z_stream stream_{};
  std::array<char, std::size_t{1} << 16> in_{};
  bool ended_ = false;
};

}  // namespace rigcal::datasets
