#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// What stands in a draft where only the user knows.
inline constexpr const char* kBlank = "FILL IN";

struct Draft {
  std::string text;                   ///< of a campaign file, with comments
  std::vector<std::string> left_out;  ///< files that it does not use, and why
};

/// Drafts a campaign file from recordings: columns and units from their names, repeats from files
/// or columns that differ in a number at the end, waveform, frequency and amplitude from the
/// signals. Everything that the files do not tell is a blank; with the blanks filled the draft is a
/// campaign that loads.
///
/// The plant is that of both chambers where either chamber's pressure is among the columns.
///
/// @param files   recordings of any format; those whose names differ in their last number only are
/// repeats
/// @param folder  record paths are written relative to it
/// @return        what was drafted. A file without a time or a channel is left out, and so is the
///                 first of a group if it cannot be read; comments of the text name them too
/// @throws InputError  no file remains: what is wrong with the first
Draft draft_campaign(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& folder);

}  // namespace rigcal::datasets
