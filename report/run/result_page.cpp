#include "report/run/result_page.hpp"

#include <optional>

#include "report/page/page.hpp"

namespace rigcal::report {

ReadFile files_in(const std::vector<ResultFile>& files) {
  return [&files](const std::filesystem::path& path) -> std::optional<std::string> {
    for (const ResultFile& file : files)
      if (file.path == path) return file.content;
    return std::nullopt;
  };
}

void add_page(const std::filesystem::path& out, int threads, std::vector<ResultFile>& files,
              const ReadTable& made) {
  const ReadFile on_disk = files_in(out);
  const ReadFile made_now = files_in(files);
  const ReadFile read = [&](const std::filesystem::path& path) {
    auto content = made_now(path);
    return content ? content : on_disk(path);
  };
  std::string page = result_page(read, out.string(), threads, made);
  files.insert(files.end() - 1, {"report.html", std::move(page)});
}

}  // namespace rigcal::report
