#include "common/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <vector>

#include "common/error.hpp"

namespace rigcal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

[[noreturn]] void fail_to_write(const fs::path& path, const std::string& why) {
  throw WriteError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

/// A new file beside the final place; removed again unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    // Process and running number keep writers of the same target apart; O_EXCL makes sure.
    static std::atomic<unsigned> running_number{0};
    const std::string name =
        fmt::format(".{}.{}.{}.tmp", target.filename().string(), ::getpid(), running_number++);
    path_ = target.parent_path() / name;
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_to_write(target, reason(errno));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }

  void write(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_to_write(target_, reason(errno));
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void rename_into_place() {
    // Without fsync a power cut can leave the new name on an empty file.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
      fail_to_write(target_, reason(errno));
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail_to_write(target_, reason(errno));
    if (::rename(path_.c_str(), target_.c_str()) != 0) fail_to_write(target_, reason(errno));
    renamed_ = true;
  }

 private:
  fs::path target_;
  fs::path path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct FreeDigest {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view content) {
  if (!path.has_filename()) fail_to_write(path, "not the name of a file");
  if (path.has_parent_path()) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) fail_to_write(path, fmt::format("its folder cannot be made: {}", error.message()));
  }
  TemporaryFile file(path);
  file.write(content);
  file.rename_into_place();
}

std::string sha256_of_file(const fs::path& path) {
  const auto fail = [&path](int error_number) {
    throw InputError(Location{path.string()}, "cannot be read: " + reason(error_number));
  };
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(errno);
  const std::unique_ptr<EVP_MD_CTX, FreeDigest> digest(EVP_MD_CTX_new());
  if (!digest || EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) != 1)
    throw Error(ExitCode::internal, "OpenSSL does not offer SHA-256");

  std::vector<unsigned char> block(kBlockBytes);
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), file.get())) > 0)
    EVP_DigestUpdate(digest.get(), block.data(), count);
  if (std::ferror(file.get()) != 0) fail(errno);

  std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
  unsigned int length = 0;
  EVP_DigestFinal_ex(digest.get(), sum.data(), &length);
  std::string text;
  for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", sum[i]);
  return text;
}

}  // namespace rigcal
