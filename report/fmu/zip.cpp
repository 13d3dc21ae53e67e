#include "report/fmu/zip.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <memory>

#include "common/error.hpp"

namespace rigcal::report {
namespace {

constexpr zip_uint16_t kDate = 0x0021;  ///< 1980-01-01, the earliest possible date
constexpr zip_uint32_t kReadable = 0100644U << 16U;

[[noreturn]] void fail(const std::string& what, const char* why) {
  throw WriteError(fmt::format("the archive cannot be created: {}: {}", what, why));
}

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct Free {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, Free>;

void add(zip_t* archive, const FmuFile& file) {
  // The content is borrowed: `files` outlives the archive.
  Source source(zip_source_buffer(archive, file.content.data(), file.content.size(), 0));
  if (!source) fail(file.path, zip_strerror(archive));
  const zip_int64_t index =
      zip_file_add(archive, file.path.c_str(), source.get(), ZIP_FL_ENC_UTF_8);
  if (index < 0) fail(file.path, zip_strerror(archive));
  static_cast<void>(source.release());  // the archive now owns the source
  const auto place = static_cast<zip_uint64_t>(index);
  if (zip_file_set_dostime(archive, place, 0, kDate, 0) != 0 ||
      zip_set_file_compression(archive, place, ZIP_CM_DEFLATE, 9) != 0 ||
      zip_file_set_external_attributes(archive, place, 0, ZIP_OPSYS_UNIX, kReadable) != 0)
    fail(file.path, zip_strerror(archive));
}

std::string bytes_of(zip_source_t* source) {
  zip_stat_t stat;
  if (zip_source_open(source) != 0 || zip_source_stat(source, &stat) != 0 ||
      (stat.valid & ZIP_STAT_SIZE) == 0)
    fail("bytes", zip_error_strerror(zip_source_error(source)));
  std::string bytes(stat.size, '\0');
  const zip_int64_t read = zip_source_read(source, bytes.data(), bytes.size());
  zip_source_close(source);
  if (read != static_cast<zip_int64_t>(bytes.size()))
    fail("bytes", zip_error_strerror(zip_source_error(source)));
  return bytes;
}

}  // namespace

std::string zipped(const std::vector<FmuFile>& files) {
  zip_error_t error;
  zip_error_init(&error);
  Source memory(zip_source_buffer_create(nullptr, 0, 0, &error));
  if (!memory) fail("memory", zip_error_strerror(&error));
  std::unique_ptr<zip_t, Discard> archive(zip_open_from_source(memory.get(), ZIP_TRUNCATE, &error));
  if (!archive) fail("memory", zip_error_strerror(&error));
  zip_source_keep(memory.get());  // the archive releases its own reference; this one is for reading
  for (const FmuFile& file : files) add(archive.get(), file);
  if (zip_close(archive.get()) != 0) fail("its end", zip_strerror(archive.get()));
  static_cast<void>(archive.release());
  return bytes_of(memory.get());
}

}  // namespace rigcal::report
