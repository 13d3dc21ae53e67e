#include "apps/rigcal/result_page.hpp"

#include <optional>

#include "report/page/page.hpp"

namespace rigcal::app {

void add_page(const std::filesystem::path& out, int threads, std::vector<report::ResultFile>& files,
              const report::ReadTable& made) {
  const report::ReadFile on_disk = report::files_in(out);
  const report::ReadFile read =
      [&](const std::filesystem::path& path) -> std::optional<std::string> {
    for (const report::ResultFile& file : files) {
      if (file.path == path) return file.content;
    }
    return on_disk(path);
  };
  std::string page = report::result_page(read, out.string(), threads, made);
  files.insert(files.end() - 1, {"report.html", std::move(page)});
}

}  // namespace rigcal::app
