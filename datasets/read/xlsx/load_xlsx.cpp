#include "datasets/read/xlsx/load_xlsx.hpp"

#include <fstream>
#include <string>

#include "common/error.hpp"
#include "common/file.hpp"
#include "datasets/read/confined_read.hpp"
#include "datasets/read/xlsx/xlsx_columns.hpp"

namespace rigcal::datasets {
namespace {

constexpr ConfinedReader kXlsxLibraries{"libzip and Expat", "an .xlsx file",
                                        "copy or save it again, or save it as CSV"};
constexpr std::string_view kZip("PK\x03\x04", 4);
/// First bytes of .xls files from before 2007, and of encrypted .xlsx files.
constexpr std::string_view kCompound("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", 8);

void require_workbook(const std::filesystem::path& path) {
  require_regular_file(path, "an .xlsx file of Excel");
  std::string start(kCompound.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start == kCompound)
    throw InputError(
        {path.string()},
        "is a workbook in the format before 2007 (.xls), or an encrypted one; save it as "
        ".xlsx without a password, or as CSV");
  if (!start.starts_with(kZip))
    throw InputError({path.string()},
                     "is not an .xlsx file: its first bytes are not those of a ZIP archive; save "
                     "it again as .xlsx, or as CSV");
}

}  // namespace

bool is_xlsx_file(const FileStart& start) {
  return start.extension == ".xlsx" || start.extension == ".xlsm" ||
         start.bytes.starts_with(kZip) || start.bytes.starts_with(kCompound);
}

std::vector<RecordColumn> xlsx_record_columns(const std::filesystem::path& path) {
  require_workbook(path);
  return list_confined(path, kXlsxLibraries, [&] { return list_xlsx_columns(path); });
}

RecordTable load_xlsx_record(const std::filesystem::path& path, const RecordRequest& request) {
  require_time_column(request);
  require_workbook(path);
  return load_confined(path, kXlsxLibraries, request.columns.size(),
                       [&] { return read_xlsx_columns(path, request); });
}

}  // namespace rigcal::datasets
