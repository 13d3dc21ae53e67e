#include "common/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>
#include <system_error>

#include "common/error.hpp"
#include "common/temporary_name.hpp"
#include "common/uninterrupted.hpp"

namespace rigcal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
constexpr int kMostLeftovers = 1000;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

[[noreturn]] void fail_to_write(const fs::path& path, const std::string& why) {
  throw WriteError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

class RegularFile {
 public:
  RegularFile(const fs::path& path, const std::string& expected) : where_{path.string()} {
    // O_NONBLOCK keeps open() from waiting for the writer of a pipe. It has no effect on regular
    // files.
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0)
      throw InputError(where_,
                       fmt::format("cannot be opened: {}; expected {}", reason(errno), expected));
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
      bytes_ = static_cast<std::size_t>(status.st_size);
      return;
    }
    ::close(descriptor_);
    throw InputError(
        where_, fmt::format("is {}; expected {}",
                            S_ISDIR(status.st_mode) ? "a folder" : "not a regular file", expected));
  }
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  ~RegularFile() { ::close(descriptor_); }

  /// Size when the file was opened.
  std::size_t bytes() const { return bytes_; }

  /// Reads into a buffer. Returns fewer bytes than its size only at the end of the file.
  std::size_t read(char* buffer, std::size_t size) const {
    std::size_t count = 0;
    while (count < size) {
      const ssize_t got = ::read(descriptor_, buffer + count, size - count);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail_to_read(errno);
      if (got == 0) break;
      count += static_cast<std::size_t>(got);
    }
    return count;
  }

 private:
  [[noreturn]] void fail_to_read(int error_number) const {
    throw InputError(where_, "cannot be read: " + reason(error_number));
  }

  Location where_;
  int descriptor_ = -1;
  std::size_t bytes_ = 0;
};

/// OpenSSL's SHA-256 in a separate context, because OpenSSL 3.0 does not check the allocation in
/// the default one.
class Sha256Algorithm {
 public:
  Sha256Algorithm() : context_(OSSL_LIB_CTX_new()) {
    if (!context_) throw std::bad_alloc();
    algorithm_.reset(EVP_MD_fetch(context_.get(), "SHA256", nullptr));
    if (!algorithm_) throw std::bad_alloc();
  }
  const EVP_MD* get() const { return algorithm_.get(); }

 private:
  struct Free {
    void operator()(OSSL_LIB_CTX* context) const { OSSL_LIB_CTX_free(context); }
    void operator()(EVP_MD* algorithm) const { EVP_MD_free(algorithm); }
  };
  std::unique_ptr<OSSL_LIB_CTX, Free> context_;
  std::unique_ptr<EVP_MD, Free> algorithm_;
};

class Sha256 {
 public:
  Sha256() : digest_(EVP_MD_CTX_new()) {
    static const Sha256Algorithm algorithm;
    if (!digest_ || EVP_DigestInit_ex(digest_.get(), algorithm.get(), nullptr) != 1)
      throw std::bad_alloc();
  }

  void add(std::string_view bytes) {
    if (EVP_DigestUpdate(digest_.get(), bytes.data(), bytes.size()) != 1) throw std::bad_alloc();
  }

  /// Returns 64 lower-case hex digits.
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
    unsigned int length = 0;
    if (EVP_DigestFinal_ex(digest_.get(), sum.data(), &length) != 1) throw std::bad_alloc();
    std::string text;
    for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", sum[i]);
    return text;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> digest_;
};

}  // namespace

/// A new file next to its target, which is removed unless it is renamed to the target. The file
/// that it replaces is kept until all files in a set have been renamed, so that each one can be
/// restored.
class TemporaryFile {
 public:
  TemporaryFile(const fs::path& target, std::string_view content) : target_(target) {
    // O_EXCL skips files left behind by a killed process with the same ID. This happens in
    // containers, where every process has ID 1.
    for (int tries = 0; descriptor_ < 0; ++tries) {
      path_ = temporary_name(target);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && (errno != EEXIST || tries == kMostLeftovers))
        fail_to_write(target, reason(errno));
    }
    try {
      write(content);
      finish();
    } catch (...) {
      end();
      throw;
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { end(); }

  /// Removes the file unless it was renamed to its target. Safe within a signal handler.
  void remove() const {
    if (!renamed_) ::unlink(path_.c_str());
  }

  /// Keeps the earlier file under a second name, for take_back(). If the file system has no hard
  /// links, rename_into_place() renames it instead.
  void keep_earlier() {
    struct stat status {};
    if (::lstat(target_.c_str(), &status) != 0 || S_ISDIR(status.st_mode)) return;
    int failed = EEXIST;
    for (int tries = 0; failed == EEXIST && tries < kMostLeftovers; ++tries) {
      earlier_ = temporary_name(target_);
      failed = ::link(target_.c_str(), earlier_.c_str()) == 0 ? 0 : errno;
    }
    kept_ = failed == 0;
  }

  /// Renames the file to its target. Allocates no memory, so that none of several files is renamed
  /// unless all can be taken back.
  ///
  /// @return  0, or errno
  int rename_into_place() noexcept {
    if (!earlier_.empty() && !kept_) {
      if (::rename(target_.c_str(), earlier_.c_str()) != 0) return errno;
      kept_ = true;
    }
    if (::rename(path_.c_str(), target_.c_str()) != 0) return errno;
    renamed_ = true;
    return 0;
  }

  /// Restores the state before rename_into_place(), whether or not that succeeded.
  void take_back() const noexcept {
    if (!kept_) {
      if (renamed_) ::unlink(target_.c_str());
      return;
    }
    // rename() does nothing if both names refer to one file, so the second name is removed.
    if (::rename(earlier_.c_str(), target_.c_str()) == 0) ::unlink(earlier_.c_str());
  }

  /// Removes the kept earlier file. take_back() is impossible afterwards.
  void settle() const noexcept {
    if (kept_) ::unlink(earlier_.c_str());
  }

  const fs::path& target() const { return target_; }

 private:
  void write(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_to_write(target_, reason(errno));
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  /// Flushes the complete file to disk and closes it; rename_into_place() comes later.
  void finish() {
    // Without fsync, a power failure can leave an empty file under the new name.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
      fail_to_write(target_, reason(errno));
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail_to_write(target_, reason(errno));
  }

  void end() const {
    if (descriptor_ >= 0) ::close(descriptor_);
    remove();
  }

  fs::path target_;
  fs::path path_;
  fs::path earlier_;  ///< second name of the earlier file; empty if there was none
  int descriptor_ = -1;
  bool kept_ = false;  ///< whether the earlier file has its second name
  bool renamed_ = false;
};

void write_file_atomically(const fs::path& path, std::string_view content) {
  write_files_atomically({{path, content}});
}

void write_files_atomically(const std::vector<std::pair<fs::path, std::string_view>>& files) {
  FilesInWriting writing;
  for (const auto& [path, content] : files) writing.add(path, content);
  writing.rename_into_place();
}

namespace {

/// Existing objects, newest first. A signal handler can access only globals.
FilesInWriting* in_writing = nullptr;
std::mutex change_in_writing;

}  // namespace

FilesInWriting::FilesInWriting() {
  const Uninterrupted whole;
  const std::lock_guard lock(change_in_writing);
  next_ = std::exchange(in_writing, this);
}

FilesInWriting::~FilesInWriting() {
  const Uninterrupted whole;
  written_.clear();
  remove_made_folders();
  const std::lock_guard lock(change_in_writing);
  FilesInWriting** place = &in_writing;
  while (*place != this) place = &(*place)->next_;
  *place = next_;
}

void FilesInWriting::remove_all() {
  for (const FilesInWriting* each = in_writing; each != nullptr; each = each->next_) {
    for (const auto& file : each->written_) file->remove();
    each->remove_made_folders();
  }
}

void FilesInWriting::remove_made_folders() const {
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
    ::rmdir(folder->c_str());  // fails if the folder is not empty
}

void FilesInWriting::make_folders(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || fs::exists(folder, error)) return;
  make_folders(folder.parent_path());
  fs::create_directory(folder, error);
  if (error) fail_to_write(folder, fmt::format("cannot be made: {}", error.message()));
  folders_.push_back(folder.string());
}

void FilesInWriting::add(const fs::path& path, std::string_view content) {
  const Uninterrupted whole;
  std::error_code error;
  if (!path.has_filename() || fs::is_directory(path, error))
    fail_to_write(path, "not the name of a file");
  make_folders(path.parent_path());
  written_.push_back(std::make_unique<TemporaryFile>(path, content));
}

// If one file cannot be renamed, those before it are restored, so that a set is never a mixture of
// two runs. All memory is allocated before the first file is renamed.
void FilesInWriting::rename_into_place() {
  const Uninterrupted whole;
  const auto take_back = [&] {
    for (auto file = written_.rbegin(); file != written_.rend(); ++file) (*file)->take_back();
  };
  if (written_.size() > 1) {
    try {
      for (const auto& file : written_) file->keep_earlier();
    } catch (...) {
      take_back();
      throw;
    }
  }
  for (const auto& file : written_) {
    const int failed = file->rename_into_place();
    if (failed == 0) continue;
    take_back();
    fail_to_write(file->target(), reason(failed));
  }
  for (const auto& file : written_) file->settle();
}

std::string read_file(const fs::path& path, std::size_t most_bytes, const std::string& expected) {
  const RegularFile file(path, expected);
  const auto check = [&](std::size_t bytes) {
    if (bytes > most_bytes)
      throw InputError({path.string()}, fmt::format("has {} bytes; expected {} of at most {} MB",
                                                    bytes, expected, most_bytes >> 20));
  };
  check(file.bytes());
  // Asks for one byte more than the file has, to detect whether it has grown.
  std::string text(file.bytes() + 1, '\0');
  std::size_t count = 0;
  for (;;) {
    count += file.read(text.data() + count, text.size() - count);
    check(count);
    if (count < text.size()) break;
    text.resize(2 * text.size());
  }
  text.resize(count);
  return text;
}

void require_regular_file(const fs::path& path, const std::string& expected) {
  const RegularFile checked(path, expected);
}

FileState state_of_file(const fs::path& path) {
  FileState state{path.string()};
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return state;
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  state.inode = status.st_ino;
  state.bytes = static_cast<std::uint64_t>(status.st_size);
  state.changed_ns = status.st_ctim.tv_sec * kNanoseconds + status.st_ctim.tv_nsec;
  return state;
}

std::string sha256_of_unchanged(const FileState& before) {
  std::string hash = sha256_of_file(before.path);
  if (state_of_file(before.path) == before) return hash;
  throw InputError({before.path},
                   "was changed while it was read, so a result could not state its inputs; "
                   "expected a file that does not change");
}

std::string sha256_of_file(const fs::path& path) {
  const RegularFile file(path, "a file");
  Sha256 digest;
  std::vector<char> block(kBlockBytes);
  std::size_t count = 0;
  while ((count = file.read(block.data(), block.size())) > 0) digest.add({block.data(), count});
  return digest.hex();
}

std::string sha256_of_text(std::string_view text) {
  Sha256 digest;
  digest.add(text);
  return digest.hex();
}

}  // namespace rigcal
