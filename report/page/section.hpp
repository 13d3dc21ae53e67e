#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/live/live_fit.hpp"
#include "report/page/page_parts.hpp"

// The kinds of results on the page, with their files and sections.

namespace rigcal::report {

/// A result folder as seen by the page.
struct ResultFolder {
  const ReadFile& read;
  std::string where;   ///< name of the folder for messages
  int threads = 1;     ///< number of threads for reading series and drawing
  bool curves = true;  ///< whether the curves of single conditions are drawn
};

/// The part of a page that comes from one result.
struct Part : doc::Document {
  std::string link;  ///< id of its first section
  std::string name;  ///< for example "Calibration"
  std::string file;  ///< file that the part is made from
  std::string campaign;
  Identity identity;
  std::optional<LiveSection> live;  ///< the simulated rig, shown after the first page
  doc::Blocks provenance;
  std::vector<InputFile> inputs;                         ///< files that the result was made from
  std::string program;                                   ///< program that made the result
  std::vector<std::pair<std::string, std::string>> nav;  ///< id and title of each section
};

struct Section {
  std::string name;                ///< for example "leak_table"
  std::vector<std::string> files;  ///< at least one exists in a folder with this kind of result
  std::function<Part(const ResultFolder&)> part;
  std::function<std::vector<Figure>(const ResultFolder&)> figures;
};

/// File of a result, name of its section, and id and title of its first part.
struct SectionTitle {
  const char* file;
  const char* section;
  const char* link;
  const char* name;
};

/// Returns the contents of the result file, without the series stored in separate files.
template <typename Files>
const auto& result_of(const Files& files) {
  if constexpr (requires { files.result; }) {
    return files.result;
  } else {
    return files;
  }
}

/// Fills in the data that all kinds of results have in common.
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

/// Returns the simulated rig written by the same run as the result, or std::nullopt if the run did
/// not write one.
std::optional<LiveSection> live_of(const StoredProvenance& provenance, const ResultFolder& folder,
                                   const std::string& file);

/// Makes a row for sections(). `load` reads the data, and all other functions receive it.
///
/// @param more  adds further data for this kind of result; null if there are none
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

/// Adds a batch. The folder of the rigs is shown in place of a campaign.
void add_batch(const StoredBatch& batch, Part& part);

/// Returns every kind of result that the page supports, in display order.
const std::vector<Section>& sections();

}  // namespace rigcal::report
