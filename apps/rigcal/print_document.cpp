#include "apps/rigcal/print_document.hpp"

#include "report/document/render_terminal.hpp"

namespace rigcal::app {

std::string text_of(const PrintedDocument& document, const PrintOptions& options) {
  std::string text =
      report::doc::render_terminal(document.verdict, document.sections, terminal_style(options));
  if (document.synthetic) text += "note: the records of this campaign are synthetic\n";
  return text;
}

void print(const PrintOptions& options, const PrintedDocument& document,
           const std::filesystem::path& folder, const std::vector<std::string>& files,
           const report::Json& json) {
  std::string text = text_of(document, options) + "files:";
  for (const std::string& file : files) text += " " + (folder / file).string();
  print(options, text + "\n", json);
}

}  // namespace rigcal::app
