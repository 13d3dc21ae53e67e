#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "report/page/page_parts.hpp"

// A kind of result on the page: what is drawn of it, and from which file of a folder.

namespace rigcal::report {

/// A folder of results, as the page reads it.
struct ResultFolder {
  const ReadFile& read;
  std::string where;    ///< for messages
  int threads = 1;      ///< that read series and draw
  ReadTable made = {};  ///< tables that this run has made, which need not be read back
};

/// What a result puts on the page.
struct Part {
  std::string link;  ///< id of its first section
  std::string name;  ///< "Calibration"
  std::string campaign;
  bool synthetic = false;
  Json headline;                       ///< as make_headline() makes it
  Json view;                           ///< data of its template
  Json identity = {{"there", false}};  ///< as identity_view() makes it
  Json overview = {{"there", false}};  ///< as overview_view() makes it
  Json provenance;
  std::vector<std::pair<const char*, const char*>> nav;  ///< id and name of its sections
};

struct Section {
  std::string name;                ///< "leak_table": of its template, leak_table.html
  std::vector<std::string> files;  ///< any of which a folder with such a result has
  std::function<Part(const ResultFolder&)> part;
  std::function<std::vector<Figure>(const ResultFolder&)> figures;
};

/// What a section is called: name of the template, id and name of its first part.
struct SectionTitle {
  const char* file;
  const char* section;
  const char* link;
  const char* name;
};

/// What a file holds, without the series beside it.
template <typename Files>
const auto& result_of(const Files& files) {
  if constexpr (requires { files.result; }) {
    return files.result;
  } else {
    return files;
  }
}

/// A row of sections(), from functions that all take what the first of them has read.
///
/// @param more  what this result says of itself beyond that; null where that is all
template <typename Files>
Section section(const SectionTitle& title, Files (*load)(const ReadFile&, const std::string&),
                Json (*headline)(const Files&), Json (*view)(const Files&),
                std::vector<Figure> (*figures)(const Files&),
                void (*more)(const Files&, Part&) = nullptr) {
  const auto part = [=](const ResultFolder& folder) {
    const Files files = load(folder.read, folder.where);
    const auto& result = result_of(files);
    Part made;
    made.link = title.link;
    made.name = title.name;
    if constexpr (requires { result.campaign; }) made.campaign = result.campaign;
    if constexpr (requires { result.synthetic; }) made.synthetic = result.synthetic;
    if constexpr (requires { result.report; }) made.identity = identity_view(result.report);
    made.headline = headline(files);
    made.view[title.section] = view(files);
    made.provenance = provenance_view(result.provenance, title.name, title.file);
    made.nav = {{title.link, title.name}};
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
