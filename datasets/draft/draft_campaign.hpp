#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// Text of a draft where only the user knows the value.
inline constexpr const char* kBlank = "FILL IN";

struct Draft {
  std::string text;                   ///< text of a campaign file, with comments
  std::vector<std::string> left_out;  ///< files that it does not use, and why
};

/// Drafts a campaign file from recordings: columns and units from their names, repeats from files
/// or columns that differ in a number at the end, waveform, frequency and amplitude from the
/// signals. Values that the files do not give are blanks; with the blanks filled the draft is a
/// campaign that loads.
///
/// The plant has two chambers if the pressure of either is among the columns.
///
/// @param files   recordings of any format; those whose names differ only in their last number are
///                repeats
/// @param folder  record paths are written relative to it
/// @return        the draft. A file without a time or a channel is left out, and so is the first of
///                a group if it cannot be read; comments of the text name them, too
/// @throws InputError  no file remains (names the problem of the first)
Draft draft_campaign(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& folder);

}  // namespace rigcal::datasets
