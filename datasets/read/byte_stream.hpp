#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace rigcal::datasets {

/// Damaged bytes; what() says in words what is wrong.
class DamagedBytes : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Bytes that come one after the other.
class ByteStream {
 public:
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// Number of bytes that were read or skipped.
  std::uint64_t position() const { return position_; }

  /// @throws DamagedBytes  there are fewer
  void read(void* to, std::size_t bytes);
  virtual void skip(std::uint64_t bytes);

  /// @throws DamagedBytes  something follows, or the stream says that it is damaged
  virtual void finish() = 0;

  /// Reads up to `bytes`; 0 at the end alone.
  virtual std::size_t next(char* to, std::size_t bytes) = 0;

 protected:
  void advance(std::uint64_t bytes) { position_ += bytes; }

 private:
  std::uint64_t position_ = 0;
};

/// A range of a file. One at a time may be in use of a file: it moves the file's own position.
class FileBytes : public ByteStream {
 public:
  FileBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes);
  std::size_t next(char* to, std::size_t bytes) override;
  /// Skipped bytes are not read.
  void skip(std::uint64_t bytes) override;
  void finish() override;

 private:
  std::ifstream& file_;
  std::uint64_t left_;
};

/// Inflated bytes of a compressed range of a file.
class InflatedBytes : public ByteStream {
 public:
  InflatedBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes);
  ~InflatedBytes() override;
  std::size_t next(char* to, std::size_t bytes) override;
  /// Also checks that the checksum is right and that nothing follows the compressed data.
  void finish() override;

 private:
  FileBytes file_;
  z_stream stream_{};
  std::array<char, std::size_t{1} << 16> in_{};
  bool ended_ = false;
};

}  // namespace rigcal::datasets
