#include "datasets/read/byte_stream.hpp"

#include <algorithm>
#include <limits>
#include <new>

namespace rigcal::datasets {

void ByteStream::read(void* to, std::size_t bytes) {
  char* at = static_cast<char*>(to);
  while (bytes > 0) {
    const std::size_t got = next(at, bytes);
    if (got == 0) throw DamagedBytes("its data end early");
    advance(got);
    at += got;
    bytes -= got;
  }
}

void ByteStream::skip(std::uint64_t bytes) {
  std::array<char, std::size_t{1} << 15> unwanted;
  while (bytes > 0) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, unwanted.size()));
    read(unwanted.data(), size);
    bytes -= size;
  }
}

FileBytes::FileBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes)
    : file_(file), left_(bytes) {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(begin));
}

std::size_t FileBytes::next(char* to, std::size_t bytes) {
  const auto wanted = static_cast<std::streamsize>(std::min<std::uint64_t>(bytes, left_));
  if (wanted == 0) return 0;
  file_.read(to, wanted);
  const auto got = static_cast<std::size_t>(file_.gcount());
  left_ -= got;
  return got;
}

void FileBytes::skip(std::uint64_t bytes) {
  if (bytes > left_) throw DamagedBytes("its data end early");
  file_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
  left_ -= bytes;
  advance(bytes);
}

void FileBytes::finish() {
  if (left_ > 0) throw DamagedBytes("its data end before the file does");
}

InflatedBytes::InflatedBytes(std::ifstream& file, std::uint64_t begin, std::uint64_t bytes)
    : file_(file, begin, bytes) {
  if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
}

InflatedBytes::~InflatedBytes() { inflateEnd(&stream_); }

std::size_t InflatedBytes::next(char* to, std::size_t bytes) {
  constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
  const auto wanted = static_cast<uInt>(std::min(bytes, kMost));
  stream_.next_out = reinterpret_cast<Bytef*>(to);
  stream_.avail_out = wanted;
  while (!ended_ && stream_.avail_out == wanted) {
    if (stream_.avail_in == 0) {
      stream_.next_in = reinterpret_cast<Bytef*>(in_.data());
      stream_.avail_in = static_cast<uInt>(file_.next(in_.data(), in_.size()));
      if (stream_.avail_in == 0) throw DamagedBytes("its compressed data end early");
    }
    const int state = inflate(&stream_, Z_NO_FLUSH);
    ended_ = state == Z_STREAM_END;
    if (!ended_ && state != Z_OK && state != Z_BUF_ERROR)
      throw DamagedBytes(stream_.msg != nullptr ? stream_.msg : "its data cannot be inflated");
  }
  return wanted - stream_.avail_out;
}

void InflatedBytes::finish() {
  char more = 0;
  if (next(&more, 1) != 0) throw DamagedBytes("its data end before the file does");
  if (stream_.avail_in > 0) throw DamagedBytes("more follows its compressed data");
  file_.finish();
}

}  // namespace rigcal::datasets
