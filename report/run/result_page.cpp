#include "report/run/result_page.hpp"

#include <optional>

#include "report/page/page.hpp"

namespace rigcal::report {
namespace {

std::vector<doc::Document> without_names(std::vector<ResultDocument> named) {
  std::vector<doc::Document> documents;
  for (ResultDocument& each : named) documents.push_back(std::move(each.document));
  return documents;
}

}  // namespace

ReadFile files_in(const std::vector<ResultFile>& files) {
  return [&files](const std::filesystem::path& path) -> std::optional<std::string> {
    for (const ResultFile& file : files)
      if (file.path == path) return file.content;
    return std::nullopt;
  };
}

std::vector<doc::Document> add_page(const std::filesystem::path& out, int threads,
                                    std::vector<ResultFile>& files, const ReadTable& made) {
  const ReadFile on_disk = files_in(out);
  const ReadFile made_now = files_in(files);
  const ReadFile read = [&](const std::filesystem::path& path) {
    auto content = made_now(path);
    return content ? content : on_disk(path);
  };
  ResultPage page = result_page(read, out.string(), threads, made);
  std::erase_if(page.documents, [&](const auto& each) { return !made_now(each.file); });
  files.insert(files.end() - 1, {"report.html", std::move(page.html)});
  return without_names(std::move(page.documents));
}

std::vector<doc::Document> documents_in(const std::vector<ResultFile>& files,
                                        const std::string& where, const ReadTable& made) {
  return without_names(result_documents(files_in(files), where, made));
}

}  // namespace rigcal::report
