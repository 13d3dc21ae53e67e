#include "datasets/read/xlsx/xlsx_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <array>

#include "common/error.hpp"

namespace rigcal::datasets {
namespace {

constexpr zip_int64_t kMostParts = 10'000;

struct ClosePart {
  void operator()(zip_file_t* part) const { zip_fclose(part); }
};

}  // namespace

struct XlsxArchive::Open {
  struct CloseArchive {
    void operator()(zip_t* opened) const { zip_discard(opened); }
  };
  std::unique_ptr<zip_t, CloseArchive> archive;
};

XlsxArchive::XlsxArchive(const std::filesystem::path& path)
    : name_(path.string()), open_(std::make_unique<Open>()) {
  int code = 0;
  open_->archive.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (!open_->archive) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw InputError(
        {name_},
        fmt::format(
            "is truncated or damaged, or not an .xlsx file (ZIP: {}); copy or save it again",
            reason));
  }
  if (zip_get_num_entries(open_->archive.get(), 0) > kMostParts)
    throw InputError(
        {name_},
        fmt::format("is an archive of more than {} files; expected a workbook", kMostParts));
}

XlsxArchive::~XlsxArchive() = default;

bool XlsxArchive::has(const std::string& part) const {
  return zip_name_locate(open_->archive.get(), part.c_str(), ZIP_FL_NOCASE) >= 0;
}

void XlsxArchive::read(const std::string& part, std::uint64_t most_bytes,
                       const std::function<bool(std::string_view)>& take) const {
  zip_t* archive = open_->archive.get();
  const auto fail = [&](const std::string& message) { throw InputError({name_}, message); };
  const zip_int64_t index = zip_name_locate(archive, part.c_str(), ZIP_FL_NOCASE);
  if (index < 0) fail(fmt::format("lacks its part '{}'; save the workbook again as .xlsx", part));
  const std::unique_ptr<zip_file_t, ClosePart> file(
      zip_fopen_index(archive, static_cast<zip_uint64_t>(index), 0));
  if (!file)
    fail(
        fmt::format("its part '{}' cannot be read (ZIP: {}); save the workbook again as .xlsx, "
                    "without a password",
                    part, zip_strerror(archive)));
  std::array<char, std::size_t{1} << 16> block;
  std::uint64_t bytes = 0;
  for (;;) {
    const zip_int64_t got = zip_fread(file.get(), block.data(), block.size());
    if (got < 0)
      fail(fmt::format("is truncated or damaged in its part '{}' (ZIP: {}); copy or save it again",
                       part, zip_file_strerror(file.get())));
    if (got == 0) return;
    bytes += static_cast<std::uint64_t>(got);
    if (bytes > most_bytes)
      fail(fmt::format("its part '{}' inflates to more than {} MB", part, most_bytes >> 20));
    if (!take(std::string_view(block.data(), static_cast<std::size_t>(got)))) return;
  }
}

}  // namespace rigcal::datasets
