#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/live/live_fit.hpp"
#include "report/page/page_parts.hpp"

// Kinds of results on the page, with their files and their sections.

namespace rigcal::report {

/// A folder of results, as the page reads it.
struct ResultFolder {
  const ReadFile& read;
  std::string where;    ///< for messages
  int threads = 1;      ///< threads for reading series and drawing
  ReadTable made = {};  ///< tables that this run has made, which need not be read back
  bool curves = true;   ///< whether the curves of single conditions are drawn
};

/// Part of a page from one result.
struct Part : doc::Document {
  std::string link;  ///< id of its first section
  std::string name;  ///< "Calibration"
  std::string file;  ///< file that the part is made from
  std::string campaign;
  Identity identity;
  std::optional<LiveSection> live;  ///< the rig in the page, after its first page
  doc::Blocks provenance;
  std::vector<InputFile> inputs;                         ///< that it was made from
  std::string program;                                   ///< program that made the result
  std::vector<std::pair<std::string, std::string>> nav;  ///< id and title of each section
};

struct Section {
  std::string name;                ///< "leak_table"
  std::vector<std::string> files;  ///< a folder with such a result has at least one of them
  std::function<Part(const ResultFolder&)> part;
  std::function<std::vector<Figure>(const ResultFolder&)> figures;
};

/// Id and title of the first part of a section.
struct SectionTitle {
  const char* file;
  const char* section;
  const char* link;
  const char* name;
};

/// Content of a file, without the series beside it.
template <typename Files>
const auto& result_of(const Files& files) {
  if constexpr (requires { files.result; }) {
    return files.result;
  } else {
    return files;
  }
}

/// Common data of any kind of result.
template <typename Result>
Part part_of(const Result& result, const char* link, const char* name, const std::string& file) {
  Part part;
  part.link = link;
  part.name = name;
  part.file = file;
  if constexpr (requires { result.campaign; }) part.campaign = result.campaign;
  if constexpr (requires { result.synthetic; }) part.synthetic = result.synthetic;
  if constexpr (requires { result.report; }) part.identity = identity_of(result.report);
  part.program = program_of(result.provenance);
  part.inputs = result.provenance.inputs;
  return part;
}

/// The rig of a result's own run in its page; nothing if the run wrote none.
std::optional<LiveSection> live_of(const StoredProvenance& provenance, const ResultFolder& folder,
                                   const std::string& file);

/// A row of sections(), from functions that all take the data that the first one has read.
///
/// @param more  further data of this kind of result; null if there are none
template <typename Files>
Section section(const SectionTitle& title, Files (*load)(const ReadFile&, const std::string&),
                doc::Verdict (*verdict)(const Files&),
                std::vector<doc::Section> (*sections)(const Files&),
                std::vector<Figure> (*figures)(const Files&),
                void (*more)(const Files&, Part&) = nullptr) {
  const auto part = [=](const ResultFolder& folder) {
    const Files files = load(folder.read, folder.where);
    const auto& result = result_of(files);
    Part made = part_of(result, title.link, title.name, title.file);
    made.verdict = verdict(files);
    made.sections = sections(files);
    for (const doc::Section& each : made.sections)
      made.nav.emplace_back(each.id, each.short_title.empty() ? each.title : each.short_title);
    made.provenance = provenance_blocks(result.provenance, title.name, title.file);
    made.live = live_of(result.provenance, folder, title.file);
    if (more != nullptr) more(files, made);
    return made;
  };
  const auto drawn = [=](const ResultFolder& folder) {
    return figures(load(folder.read, folder.where));
  };
  return {title.section, {title.file}, part, drawn};
}

/// Every kind of result that the page knows, in the order in which it shows them.
const std::vector<Section>& sections();

}  // namespace rigcal::report
