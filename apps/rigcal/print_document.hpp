#pragma once

#include <filesystem>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "report/document/document.hpp"

namespace rigcal::app {

/// A result as its document shows it, on page and terminal alike.
struct PrintedDocument {
  report::doc::Verdict verdict;
  std::vector<report::doc::Section> sections;
  bool synthetic = false;  ///< its records are
};

/// The text of a document, in as many lines as a terminal should have of it.
std::string text_of(const PrintedDocument& document, const PrintOptions& options);

/// Prints a result on stdout, as text or as JSON, and where its files are.
///
/// @param files  of the folder, those to be opened first
/// @throws WriteError  stdout does not take it
void print(const PrintOptions& options, const PrintedDocument& document,
           const std::filesystem::path& folder, const std::vector<std::string>& files,
           const report::Json& json);

}  // namespace rigcal::app
