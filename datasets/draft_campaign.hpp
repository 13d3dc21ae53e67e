#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rigcal::datasets {

/// What stands in a draft where only the user knows.
inline constexpr const char* kBlank = "FILL IN";

/// Drafts a campaign file from recordings: columns and units from their names, repeats from files
/// or columns that differ in a number at the end, waveform, frequency and amplitude from the
/// signals. Everything that the files do not tell is a blank; with the blanks filled the draft is a
/// campaign that loads.
///
/// The plant is that of both chambers where either chamber's pressure is among the columns.
///
/// @param files   CSV or MAT files; those whose names differ in their last number only are repeats
/// @param folder  record paths are written relative to it
/// @return        the text of a campaign file, with comments
/// @throws InputError  a file is wrong, or no file holds a column that looks like a time and one
/// like
///                     a channel
std::string draft_campaign(const std::vector<std::filesystem::path>& files,
                           const std::filesystem::path& folder);

}  // namespace rigcal::datasets
