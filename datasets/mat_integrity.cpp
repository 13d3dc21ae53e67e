#include "datasets/mat_integrity.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "common/error.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kHeaderBytes = 128;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;
constexpr std::size_t kBlockBytes = std::size_t{1} << 16;

using MatHeader = std::array<char, kHeaderBytes>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& message) {
  throw InputError({path.string()}, message);
}

/// What follows a variable's tag: type and size in bytes.
struct Tag {
  std::uint32_t type = 0;
  std::uint32_t bytes = 0;
};

Tag decode(const char* bytes, bool swapped) {
  Tag tag;
  std::memcpy(&tag.type, bytes, 4);
  std::memcpy(&tag.bytes, bytes + 4, 4);
  if (swapped) {
    tag.type = __builtin_bswap32(tag.type);
    tag.bytes = __builtin_bswap32(tag.bytes);
  }
  return tag;
}

/// Inflates one compressed variable to its end; empty if all is well.
class Inflater {
 public:
  Inflater() { usable_ = inflateInit(&stream_) == Z_OK; }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  std::string problem_of(std::ifstream& file, std::uint32_t bytes) {
    if (!usable_) return "cannot be inflated";
    std::array<char, kBlockBytes> in{};
    std::array<char, kBlockBytes> out{};
    int state = Z_OK;
    while (bytes > 0 && state == Z_OK) {
      const auto size = std::min<std::uint32_t>(bytes, kBlockBytes);
      if (!file.read(in.data(), size)) return "cannot be read";
      bytes -= size;
      stream_.next_in = reinterpret_cast<Bytef*>(in.data());
      stream_.avail_in = size;
      do {
        stream_.next_out = reinterpret_cast<Bytef*>(out.data());
        stream_.avail_out = kBlockBytes;
        state = inflate(&stream_, Z_NO_FLUSH);
        if (state == Z_BUF_ERROR) state = Z_OK;  // wants more input
      } while (state == Z_OK && (stream_.avail_in > 0 || stream_.avail_out == 0));
    }
    if (state == Z_STREAM_END && bytes == 0 && stream_.avail_in == 0) return {};
    return stream_.msg != nullptr ? stream_.msg : "its compressed data end early";
  }

 private:
  z_stream stream_{};
  bool usable_ = false;
};

void check_version_5(const std::filesystem::path& path, std::ifstream& file,
                     const MatHeader& header, std::uintmax_t file_bytes) {
  const std::string_view order(header.data() + 126, 2);
  if (order != "IM" && order != "MI")
    fail(path, "is damaged: its header does not tell the order of the bytes");
  const bool swapped = order == "MI";
  std::uintmax_t at = kHeaderBytes;
  for (int number = 1; at < file_bytes; ++number) {
    std::array<char, 8> raw{};
    const bool whole_tag = at + raw.size() <= file_bytes && file.read(raw.data(), raw.size());
    const Tag tag = decode(raw.data(), swapped);
    if (!whole_tag || at + raw.size() + tag.bytes > file_bytes)
      fail(path, fmt::format("ends within variable {}, which begins at byte {}: the file is "
                             "truncated or damaged; copy or save it again",
                             number, at + 1));
    std::string problem;
    if (tag.type == kCompressed) {
      problem = Inflater().problem_of(file, tag.bytes);
    } else if (tag.type == kMatrix) {
      file.seekg(tag.bytes, std::ios::cur);
    } else {
      problem = fmt::format("its data type is {}, which is no variable", tag.type);
    }
    if (!problem.empty())
      fail(path, fmt::format("is damaged in variable {}, which begins at byte {} ({}); copy or "
                             "save it again",
                             number, at + 1, problem));
    at += raw.size() + tag.bytes;
  }
  if (at == kHeaderBytes) fail(path, "holds no variables; expected at least one");
}

/// Keeps the innermost description of HDF5's error stack.
herr_t keep_description(unsigned /*depth*/, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

void check_version_73(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file >= 0) {
    H5Fclose(file);
    return;
  }
  std::string reason = "no reason given";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* text) {
        return depth == 0 ? keep_description(depth, error, text) : 0;
      },
      &reason);
  fail(path, fmt::format("is truncated or damaged (HDF5: {}); copy or save it again", reason));
}

}  // namespace

static_assert(std::is_same_v<hid_t, long>);

QuietHdf5::QuietHdf5() {
  H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, handler_, data_); }

void require_intact_mat_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail(path, "is a folder; expected a MAT file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be opened: " + std::generic_category().message(errno));
  const auto bytes = std::filesystem::file_size(path, error);
  MatHeader header{};
  if (error || !file.read(header.data(), header.size()))
    fail(path, "is shorter than the header of a MAT file: it is empty, truncated or no MAT file");
  const std::string_view text(header.data(), header.size());
  if (text.starts_with("MATLAB 7.3")) return check_version_73(path);
  if (text.starts_with("MATLAB 5.0")) return check_version_5(path, file, header, bytes);
  fail(path,
       "is no MAT file of version 5 or 7.3; expected one (of an older version: load it and save "
       "it with -v7)");
}

}  // namespace rigcal::datasets
